#include "app/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace rovigo::app {

unsigned machine_threads() { return std::max(1U, std::thread::hardware_concurrency()); }

void run_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work,
                  const std::function<void(double share)>& progress) {
  std::atomic<std::size_t> next = 0;
  std::mutex mutex;  // guards the two below, and calls of progress
  std::size_t done = 0;
  std::exception_ptr problem;
  const auto worker = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        const std::lock_guard lock(mutex);
        if (!problem) problem = std::current_exception();
        next = count;
        return;
      }
      const std::lock_guard lock(mutex);
      ++done;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(count));
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (std::size_t i = 1; i < std::min<std::size_t>(threads, count); ++i) {
      helpers.emplace_back(worker);
    }
    worker();
  }
  if (problem) std::rethrow_exception(problem);
}

}  // namespace rovigo::app
