#include "app/report/number_text.h"

#include <array>
#include <charconv>
#include <cmath>

#include "maps/geometry.h"

namespace rovigo::app {

std::string fixed(double value, int decimals) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::array<char, 400> buffer{};  // the largest double has 309 digits before the point
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                 std::chars_format::fixed, decimals);
  std::string text(buffer.data(), end.ptr);
  if (text.front() == '-' && text.find_first_not_of("-0.") == std::string::npos) text.erase(0, 1);
  return text;
}

std::string quantity(double value, const std::string& unit) {
  if (!std::isfinite(value)) return "–";
  if (unit == "m") {
    return std::abs(value) < 0.1 ? fixed(value * 1000.0, 1) + " mm" : fixed(value, 2) + " m";
  }
  if (unit == "rad") {
    return fixed(value * 180.0 / maps::kPi, 2) + "° (" + fixed(value, 4) + " rad)";
  }
  if (unit == "%") return fixed(value * 100.0, 1) + " %";
  if (unit == "s") return fixed(value, 1) + " s";
  if (unit.empty()) return value == std::floor(value) ? fixed(value, 0) : fixed(value, 3);
  return fixed(value, 3) + " " + unit;
}

std::string escaped(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        // Control characters are not allowed in XML at all.
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') out += c;
    }
  }
  return out;
}

}  // namespace rovigo::app
