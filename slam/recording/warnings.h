#pragma once

#include <string>
#include <vector>

namespace rovigo::slam {

/// Sentences for the user, at most a few dozen; what comes after is only counted.
class WarningList {
 public:
  void add(std::string sentence);
  std::vector<std::string> sentences() const;

 private:
  static constexpr std::size_t kMost = 20;
  std::vector<std::string> first_;
  std::size_t more_ = 0;
};

}  // namespace rovigo::slam
