#include "slam/recording/warnings.h"

#include <utility>

namespace rovigo::slam {

void WarningList::add(std::string sentence) {
  if (first_.size() < kMost) {
    first_.push_back(std::move(sentence));
  } else {
    ++more_;
  }
}

std::vector<std::string> WarningList::sentences() const {
  std::vector<std::string> all = first_;
  if (more_ > 0) all.push_back("... and " + std::to_string(more_) + " more like these.");
  return all;
}

}  // namespace rovigo::slam
