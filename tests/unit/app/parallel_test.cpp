#include "app/parallel.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace rovigo::app {
namespace {

TEST(RunParallel, EveryJobIsDoneOnceForAnyNumberOfThreads) {
  for (const unsigned threads : {0U, 1U, 4U, 100U}) {
    std::vector<int> done(37, 0);
    double last = 0.0;
    run_parallel(
        done.size(), threads, [&](std::size_t i) { ++done[i]; }, [&](double s) { last = s; });
    EXPECT_EQ(done, std::vector<int>(37, 1)) << threads;
    EXPECT_EQ(last, 1.0);
  }
  run_parallel(0, 4, [](std::size_t) { FAIL(); });
}

TEST(RunParallel, WhatAJobThrowsIsThrownOn) {
  EXPECT_THROW(run_parallel(10, 3,
                            [](std::size_t i) {
                              if (i == 5) throw std::runtime_error("five");
                            }),
               std::runtime_error);
}

}  // namespace
}  // namespace rovigo::app
