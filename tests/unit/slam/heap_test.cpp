#include "slam/heap.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstddef>
#include <fstream>
#include <memory>
#include <vector>

namespace rovigo::slam {
namespace {

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double total_pages = 0.0, resident_pages = 0.0;
  statm >> total_pages >> resident_pages;
  return resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1024.0 * 1024.0);
}

TEST(Heap, FreePagesBetweenWhatIsKeptGoBackToTheSystem) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer's own heap keeps its pages";
#endif
  constexpr std::size_t kBlocks = 1000, kBlockBytes = 64 * 1024;  // 62 MB, below mmap's threshold
  std::vector<std::unique_ptr<std::vector<char>>> freed, kept;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    freed.push_back(std::make_unique<std::vector<char>>(kBlockBytes, 'x'));
    kept.push_back(std::make_unique<std::vector<char>>(64, 'x'));  // holds the heap's top up
  }
  const double held = resident_mb();
  freed.clear();
  give_back_free_memory();
  EXPECT_LT(resident_mb(), held - 40.0);
}

}  // namespace
}  // namespace rovigo::slam
