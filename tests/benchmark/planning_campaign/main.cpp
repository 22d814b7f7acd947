// Random queries on all maps through the whole planner with its default settings, every trajectory
// checked: `./run bench planning campaign [QUERIES]`. Exit code 1 when anything is wrong.

#include <cstdio>
#include <cstdlib>
#include <string>

#include "app/parallel.h"
#include "tests/support/planning_campaign.h"

namespace {

using rovigo::test::CampaignReport;

void print(const std::string& name, const CampaignReport& r) {
  std::string refused;
  for (const auto& [status, count] : r.refused) {
    refused += (refused.empty() ? "" : ", ") + std::to_string(count) + " " + status;
  }
  std::printf("| %-24s | %7zu | %7zu | %7zu | %9.1f | %9zu | %6zu | %5zu | %s |\n", name.c_str(),
              r.queries, r.planned, r.escapes, r.length_m / 1000.0, r.samples / 1000,
              r.unsafe_samples, r.failures() - r.unsafe_samples, refused.c_str());
  for (std::size_t i = 0; i < r.troubles.size() && i < 5; ++i) {
    std::printf("  %s\n", r.troubles[i].c_str());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t total = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 10000;
  const auto maps = rovigo::test::campaign_maps(10);
  std::printf(
      "| map                      | queries | planned | escapes | km driven | k samples | unsafe | "
      "wrong | refused |\n|---|---|---|---|---|---|---|---|---|\n");
  CampaignReport sum;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::size_t share = total / maps.size() + (i < total % maps.size() ? 1 : 0);
    const CampaignReport report = rovigo::test::run_campaign(
        maps[i].second,
        {.queries = share, .seed = i + 1, .threads = rovigo::app::machine_threads()});
    print(maps[i].first, report);
    sum.add(report);
  }
  sum.troubles.clear();  // printed map by map
  print("all", sum);
  return sum.failures() == 0 && sum.queries == total ? 0 : 1;
}
