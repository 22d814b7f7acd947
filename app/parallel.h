#pragma once
// Independent jobs on several threads. Which thread does what is left to chance, so a job may only
// write to its own place; then the result does not depend on the number of threads.

#include <cstddef>
#include <functional>

namespace rovigo::app {

/// As many as the machine has, at least one.
unsigned machine_threads();

/// Calls `work(0)` .. `work(count - 1)`, and `progress` with the share done after each, one call at
/// a time. What a job throws ends the others after the jobs under way, and is thrown on.
void run_parallel(std::size_t count, unsigned threads, const std::function<void(std::size_t)>& work,
                  const std::function<void(double share)>& progress = {});

}  // namespace rovigo::app
