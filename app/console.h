#pragma once
// Everything the program says: words or one JSON object on stdout; progress and errors on stderr.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

namespace rovigo::app {

/// Exit codes of the command line (design.md).
enum ExitCode { kDone = 0, kDidNotSucceed = 1, kBadInput = 2 };

/// The label and the value of one line of a result table.
using Row = std::pair<std::string, std::string>;

class Console {
 public:
  explicit Console(bool json) : json_(json) {}

  bool json() const { return json_; }

  /// A plain sentence for people; silent with --json.
  void say(const std::string& sentence) const;
  /// A sentence that a person should not miss, on stderr.
  void warn(const std::string& sentence) const;
  /// The result: the JSON object with --json, else a headline and an aligned table.
  void result(const nlohmann::ordered_json& object, const std::string& headline,
              const std::vector<Row>& rows) const;

 private:
  bool json_;
};

/// A bar on a terminal, a line for each tenth elsewhere; always on stderr.
class Progress {
 public:
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `share` 0 .. 1; calling it often is cheap.
  void update(double share);

 private:
  void draw(int percent);
  std::string label_;
  bool terminal_;
  int shown_percent_ = -1;
};

/// `value` with `digits` after the point and its unit, e.g. "1.23 m".
std::string with_unit(double value, int digits, const std::string& unit);

}  // namespace rovigo::app
