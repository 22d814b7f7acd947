#pragma once
// "Did you mean ...?"

#include <string>
#include <vector>

namespace rovigo::maps {

/// The candidate with the smallest edit distance to `word` (its first 64 characters), to suggest
/// for a misspelt name; the first of equals, empty when there are none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace rovigo::maps
