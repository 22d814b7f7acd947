// The layers of ARCHITECTURE.md, enforced: who may include whom, and which library belongs to whom.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  fs::path file;
  int line;
  std::string module;  // of the including file
  std::string target;
};

std::vector<Include> all_includes() {
  const fs::path root = ROVIGO_SOURCE_DIR;
  const std::regex pattern(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
  std::vector<Include> out;
  for (const std::string module : {"maps", "slam", "planning", "control", "sim", "app"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / module)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      std::ifstream in(entry.path());
      std::string text;
      for (int line = 1; std::getline(in, text); ++line) {
        std::smatch match;
        if (std::regex_search(text, match, pattern)) {
          out.push_back({fs::relative(entry.path(), root), line, module, match[1]});
        }
      }
    }
  }
  return out;
}

std::string where(const Include& i) {
  return i.file.string() + ":" + std::to_string(i.line) + " includes " + i.target;
}

TEST(Layers, EveryModuleIncludesOnlyTheModulesBelowIt) {
  const std::set<std::string> modules{"maps", "slam", "planning", "control", "sim", "app"};
  const std::map<std::string, std::set<std::string>> below{
      {"maps", {}},           {"slam", {"maps"}},
      {"planning", {"maps"}}, {"control", {"maps"}},
      {"sim", {"maps"}},      {"app", {"maps", "slam", "planning", "control", "sim"}}};
  int edges = 0;
  for (const Include& i : all_includes()) {
    const std::string target = i.target.substr(0, i.target.find('/'));
    if (i.target.find('/') == std::string::npos || !modules.count(target) || target == i.module)
      continue;
    ++edges;
    const bool trajectory_type = i.module == "control" && i.target == "planning/trajectory.h";
    EXPECT_TRUE(below.at(i.module).count(target) || trajectory_type) << where(i);
  }
  EXPECT_GT(edges, 20) << "the walk found hardly any includes: is it looking in the right place?";
}

TEST(Layers, EveryHeavyLibraryStaysBehindItsModule) {
  // Prefix of the include path, and the folders that may use it.
  const std::vector<std::pair<std::string, std::set<std::string>>> owners{
      {"ompl/", {"planning"}},    {"btBullet", {"sim"}},      {"Bullet", {"sim"}},
      {"LinearMath/", {"sim"}},   {"embree", {"sim"}},        {"sdf/", {"sim"}},
      {"mrpt/vision/", {"slam"}}, {"mrpt/slam/", {"slam"}},   {"ceres/", {"slam"}},
      {"CLI/", {"app"}},          {"SQLiteCpp/", {"maps"}},   {"sqlite3.h", {"maps"}},
      {"octomap/", {"maps"}},     {"pcl/", {"maps", "slam"}}, {"boost/", {"app", "slam"}}};
  for (const Include& i : all_includes()) {
    for (const auto& [prefix, modules] : owners) {
      if (i.target.rfind(prefix, 0) != 0) continue;
      EXPECT_TRUE(modules.count(i.module)) << where(i);
    }
  }
}

TEST(Layers, LibrariesNeitherPrintNorExitNorReadTheEnvironmentOrAClock) {
  const std::regex forbidden(
      R"(std::cout|std::cerr|\bprintf\(|\bputs\(|std::exit|\babort\(\)|getenv|steady_clock|system_clock|srand\(|std::random_device)");
  for (const std::string module : {"maps", "slam", "planning", "control", "sim"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(ROVIGO_SOURCE_DIR) / module)) {
      if (entry.path().extension() != ".h" && entry.path().extension() != ".cpp") continue;
      std::ifstream in(entry.path());
      std::string text;
      for (int line = 1; std::getline(in, text); ++line) {
        EXPECT_FALSE(std::regex_search(text.substr(0, text.find("//")), forbidden))
            << entry.path() << ":" << line << ": " << text;
      }
    }
  }
}

TEST(Layers, TheTopLevelHoldsOnlyWhatTheDesignNames) {
  const std::set<std::string> folders{"app", "slam", "planning", "control", "sim", "maps", "tests"};
  for (const auto& entry : fs::directory_iterator(ROVIGO_SOURCE_DIR)) {
    const std::string name = entry.path().filename();
    if (!entry.is_directory() || name[0] == '.' || name == "build" || name == "runs") continue;
    EXPECT_TRUE(folders.count(name)) << name;
  }
}

}  // namespace
