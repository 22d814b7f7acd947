#include "maps/settings.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "maps/error.h"

namespace rovigo::maps {

std::string range_problem(const SettingInfo& info, double value) {
  if (std::isfinite(value) && value >= info.min && value <= info.max) return {};
  std::ostringstream s;
  s << info.name << " = " << value << " is outside [" << info.min << ", " << info.max << "]";
  return s.str();
}

std::string choice_problem(const SettingInfo& info, const std::string& value) {
  const auto& c = info.choices;
  if (c.empty() || std::find(c.begin(), c.end(), value) != c.end()) return {};
  std::string s = info.name + " = \"" + value + "\" is not one of";
  for (std::size_t i = 0; i < c.size(); ++i) s += (i ? ", " : " ") + c[i];
  return s;
}

namespace detail {

void RangeCheck::real(const SettingInfo& info, double& value) { note(range_problem(info, value)); }
void RangeCheck::integer(const SettingInfo& info, int& value) { note(range_problem(info, value)); }
void RangeCheck::text(const SettingInfo& info, std::string& value) {
  note(choice_problem(info, value));
}

void RangeCheck::note(std::string problem) {
  if (!problem.empty()) problems_.push_back(std::move(problem));
}

void RangeCheck::throw_if_any() const {
  if (problems_.empty()) return;
  std::string all;
  for (const auto& p : problems_) all += (all.empty() ? "" : "; ") + p;
  throw InputError(all);
}

}  // namespace detail

}  // namespace rovigo::maps
