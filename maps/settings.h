#pragma once
// Settings declared in one place: name, unit, range, default and help stand next to the field, and
// serve the YAML loader, the range check, `rovigo config` and the generated documentation alike.
//
//   struct AStarConfig {
//     double heuristic_weight = 1.0;
//     void describe(SettingsVisitor& v) {
//       v.real({.name = "heuristic_weight", .help = "...", .min = 1, .max = 5}, heuristic_weight);
//     }
//   };

#include <limits>
#include <string>
#include <vector>

namespace rovigo::maps {

struct SettingInfo {
  std::string name;  ///< snake_case, with the unit unless it has none
  std::string help;  ///< one sentence
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::vector<std::string> choices = {};  ///< for text settings: what is allowed; empty: anything
  bool advanced = true;                   ///< false: shown to every user
};

/// Receives every setting of a config struct, in declaration order, with a reference to its value.
class SettingsVisitor {
 public:
  virtual ~SettingsVisitor() = default;
  virtual void real(const SettingInfo& info, double& value) = 0;
  virtual void integer(const SettingInfo& info, int& value) = 0;
  virtual void flag(const SettingInfo& info, bool& value) = 0;
  virtual void text(const SettingInfo& info, std::string& value) = 0;
};

/// One sentence for a value outside its range or choices; empty when it is inside.
std::string range_problem(const SettingInfo& info, double value);
std::string choice_problem(const SettingInfo& info, const std::string& value);

/// Checks every field of `config` (any struct with `describe`) against its declared range.
/// Throws InputError that lists every bad field at once.
template <class Config>
void validate(const Config& config);

namespace detail {

class RangeCheck final : public SettingsVisitor {
 public:
  void real(const SettingInfo& info, double& value) override;
  void integer(const SettingInfo& info, int& value) override;
  void flag(const SettingInfo&, bool&) override {}
  void text(const SettingInfo& info, std::string& value) override;
  void throw_if_any() const;

 private:
  void note(std::string problem);
  std::vector<std::string> problems_;
};

}  // namespace detail

template <class Config>
void validate(const Config& config) {
  Config copy = config;  // describe() hands out references; the check must not need a mutable one
  detail::RangeCheck check;
  copy.describe(check);
  check.throw_if_any();
}

}  // namespace rovigo::maps
