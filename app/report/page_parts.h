#pragma once
// What the pages of all reports share: their look and their small parts.

#include <string>
#include <vector>

namespace rovigo::app {

/// From the doctype to the open <main>.
std::string page_begin(const std::string& title);
/// The headline with its badge.
std::string page_title(const std::string& title, bool good, const std::string& badge);
/// A large number with its name below; both are text.
std::string page_figure(const std::string& name, const std::string& value);
/// A row of a table; all but the first cell are figures.
std::string page_cells(const std::vector<std::string>& cells);
std::string page_heads(const std::vector<std::string>& heads);

}  // namespace rovigo::app
