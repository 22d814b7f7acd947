#include "race.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>

namespace rovigo::benchmarks {

namespace {

constexpr int kRounds = 3;

}  // namespace

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0.0 : values[values.size() / 2];
}

double fastest_ms(int calls, const std::function<void()>& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < calls; ++i) {
    const double begin = cpu_ms();
    work();
    best = std::min(best, cpu_ms() - begin);
  }
  return best;
}

void race(std::vector<Method>& methods, const std::vector<CellPair>& queries) {
  for (int round = 0; round < kRounds; ++round) {
    for (Method& m : methods) {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        const double begin = cpu_ms();
        const double length = m.answer(queries[i]);
        m.times_ms.push_back(cpu_ms() - begin);
        if (round == 0) m.lengths.push_back(length);
        const double want = methods.front().lengths[i];
        if (m.exact && std::abs(length - want) > 1e-3 * want) {
          std::printf("  %s disagrees: %.4f, not %.4f cells\n", m.name.c_str(), length, want);
        }
      }
    }
  }
}

void print_head() {
  std::printf(
      "| map                  | what                             |  CPU ms   | times    | length | "
      "asked |\n|---|---|---|---|---|---|\n");
}

void print(const std::string& map, const std::vector<Method>& methods) {
  const double yardstick = median(methods.front().times_ms);
  for (const Method& m : methods) {
    const double ms = median(m.times_ms);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < m.lengths.size(); ++i) {
      ratios.push_back(m.lengths[i] / methods.front().lengths[i]);
    }
    char asked[64] = "-";
    if (m.asked_ratio > 0.0) {
      std::snprintf(asked, sizeof asked, "%.0f times%s", m.asked_ratio,
                    yardstick / ms >= m.asked_ratio ? "" : " MISSED");
    } else if (m.asked_ms > 0.0) {
      std::snprintf(asked, sizeof asked, "%.0f ms%s", m.asked_ms,
                    ms <= m.asked_ms ? "" : " MISSED");
    }
    std::printf("| %-20s | %-32s | %9.4f | %8.1f | %.4f | %s |\n", map.c_str(), m.name.c_str(), ms,
                yardstick / ms, median(ratios), asked);
  }
  std::fflush(stdout);
}

void print_figure(const std::string& map, const std::string& what, double value, double asked,
                  bool at_least) {
  char text[64] = "-";
  if (asked > 0.0) {
    const bool met = at_least ? value >= asked : value <= asked;
    std::snprintf(text, sizeof text, "%s %g%s", at_least ? "at least" : "at most", asked,
                  met ? "" : " MISSED");
  }
  std::printf("| %-20s | %s | %.4g | %s |\n", map.c_str(), what.c_str(), value, text);
  std::fflush(stdout);
}

}  // namespace rovigo::benchmarks
