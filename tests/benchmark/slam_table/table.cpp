#include "tests/benchmark/slam_table/table.h"

#include <algorithm>

namespace rovigo::slam_table {

using test::Check;
using test::Figure;
using test::figure_of;
using test::figure_text;
using test::SlamScore;

namespace {

struct Column {
  const char* title;
  SlamScore::Value SlamScore::*figure;
  bool at_least;
};

const std::vector<Column>& columns() {
  using S = SlamScore;
  static const std::vector<Column> all{
      {"ATE m", &S::ate_m, false},
      {"coverage", &S::coverage, true},
      {"tracked", &S::tracked, true},
      {"loops", &S::loops, true},
      {"precision 1 cell", &S::precision_1, true},
      {"precision 2 cells", &S::precision_2, true},
      {"recall 1 cell", &S::recall_1, true},
      {"recall 2 cells", &S::recall_2, true},
      {"free IoU", &S::free_iou, true},
      {"free IoU in view", &S::free_iou_in_view, true},
      {"CPU ms/frame", &S::cpu_ms, false},
      {"peak MB", &S::peak_mb, false},
      {"first pose ms", &S::first_pose_ms, false},
      {"confidently wrong frames", &S::wrong_frames, false},
      {"NEES position", &S::nees_position, false},
      {"NEES heading", &S::nees_heading, false},
  };
  return all;
}

const Figure& figure_named(SlamScore::Value SlamScore::*value) {
  Check check{};
  check.figure = value;
  return figure_of(check);
}

std::string cell(const std::vector<SlamScore>& scores, const Column& column) {
  const auto summary = summary_of(scores, column.figure, column.at_least);
  if (!summary) return " - |";
  const Figure& figure = figure_named(column.figure);
  std::string text = " " + figure_text(figure, summary->median);
  if (scores.size() > 1) text += " (" + figure_text(figure, summary->worst) + ")";
  return text + " |";
}

std::string verdict(const CaseResult& result, const Check& check) {
  const Figure& figure = figure_of(check);
  const bool at_least = check.sense == Check::Sense::kAtLeast;
  const std::string sign = at_least ? ">= " : "<= ";
  std::string line = "| " + result.of->name + " | " + figure.name + " | " + sign +
                     figure_text(figure, check.median);
  if (check.worst) line += " (" + sign + figure_text(figure, *check.worst) + ")";
  const auto summary = summary_of(result.scores, check.figure, at_least);
  if (!summary) return line + " | - | - | MISS: not measured |\n";
  const bool passes = result.failures.empty() && holds(check, summary->median, check.median) &&
                      (!check.worst || holds(check, summary->worst, *check.worst));
  return line + " | " + figure_text(figure, summary->median) + " | " +
         figure_text(figure, summary->worst) + " | " + (passes ? "pass" : "MISS") + " |\n";
}

}  // namespace

std::optional<Summary> summary_of(const std::vector<SlamScore>& scores,
                                  SlamScore::Value SlamScore::*figure, bool at_least) {
  std::vector<double> values;
  for (const SlamScore& s : scores) {
    if (s.*figure) values.push_back(*(s.*figure));
  }
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  if (at_least) std::reverse(values.begin(), values.end());
  return Summary{values[values.size() / 2], values.back()};
}

std::string overview(const std::vector<CaseResult>& results) {
  std::string text = "| recording, median (worst) |";
  std::string rule = "|---|";
  for (const Column& c : columns()) {
    text += std::string(" ") + c.title + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const CaseResult& r : results) {
    text += "| " + r.of->name + ", " + std::to_string(r.scores.size()) + " |";
    for (const Column& c : columns()) text += cell(r.scores, c);
    text += "\n";
  }
  return text;
}

std::string verdicts(const std::vector<CaseResult>& results) {
  std::string text =
      "| recording | figure | asked (worst) | median | worst | |\n|---|---|---|---|---|---|\n";
  for (const CaseResult& r : results) {
    for (const Check& check : r.of->checks) text += verdict(r, check);
  }
  for (const CaseResult& r : results) {
    for (const std::string& f : r.failures) text += "\nFAILED " + f + "\n";
  }
  return text;
}

}  // namespace rovigo::slam_table
