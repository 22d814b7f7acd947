#include "app/console.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace rovigo::app {

void Console::say(const std::string& sentence) const {
  if (!json_) std::printf("%s\n", sentence.c_str());
}

void Console::warn(const std::string& sentence) const {
  std::fprintf(stderr, "rovigo: warning: %s\n", sentence.c_str());
}

void Console::result(const nlohmann::ordered_json& object, const std::string& headline,
                     const std::vector<Row>& rows) const {
  if (json_) {
    // Replacing invalid UTF-8 (hostile file names) keeps the output JSON whatever came in.
    std::printf("%s\n",
                object.dump(2, ' ', false, nlohmann::json::error_handler_t::replace).c_str());
    return;
  }
  if (!headline.empty()) std::printf("%s\n", headline.c_str());
  std::size_t width = 0;
  for (const auto& [label, value] : rows) width = std::max(width, label.size());
  for (const auto& [label, value] : rows) {
    std::printf("  %-*s  %s\n", static_cast<int>(width), label.c_str(), value.c_str());
  }
}

Progress::Progress(std::string label) : label_(std::move(label)), terminal_(isatty(2) != 0) {
  update(0.0);
}

Progress::~Progress() {
  if (terminal_ && shown_percent_ >= 0) std::fputc('\n', stderr);
}

void Progress::update(double share) {
  const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
  const int step = terminal_ ? 1 : 10;
  if (shown_percent_ >= 0 && percent / step == shown_percent_ / step) return;
  draw(percent);
  shown_percent_ = percent;
}

void Progress::draw(int percent) {
  if (!terminal_) {
    std::fprintf(stderr, "%s: %d%%\n", label_.c_str(), percent);
    return;
  }
  constexpr int kWidth = 40;
  const int filled = percent * kWidth / 100;
  std::string bar(static_cast<std::size_t>(filled), '#');
  bar.resize(kWidth, '.');
  std::fprintf(stderr, "\r%-12s [%s] %3d%%", label_.c_str(), bar.c_str(), percent);
  std::fflush(stderr);
}

std::string with_unit(double value, int digits, const std::string& unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return unit.empty() ? text : std::string(text) + " " + unit;
}

}  // namespace rovigo::app
