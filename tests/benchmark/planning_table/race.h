#pragma once
// Methods that answer the same queries, timed in turns.

#include <functional>
#include <string>
#include <vector>

#include "long_queries.h"

namespace rovigo::benchmarks {

double cpu_ms();
double median(std::vector<double> values);
/// CPU milliseconds of the fastest of some calls.
double fastest_ms(int calls, const std::function<void()>& work);

struct Method {
  std::string name;
  double asked_ratio = 0.0;  ///< times faster than the first method; 0: no figure asked
  double asked_ms = 0.0;     ///< 0: no figure asked
  bool exact = true;         ///< its length must be that of the first method
  std::function<double(const CellPair&)> answer;  ///< length in cells
  std::vector<double> times_ms = {};
  std::vector<double> lengths = {};
};

/// The methods take turns, round by round, so that the machine's moods hit all alike.
void race(std::vector<Method>& methods, const std::vector<CellPair>& queries);

void print_head();
/// Median times, ratios to the first method, and lengths against `optimal` (its lengths).
void print(const std::string& map, const std::vector<Method>& methods);
/// One measured figure against an asked one (0: none); smaller is better unless `at_least`.
void print_figure(const std::string& map, const std::string& what, double value, double asked,
                  bool at_least = false);

}  // namespace rovigo::benchmarks
