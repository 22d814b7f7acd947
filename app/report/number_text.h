#pragma once
// Numbers as text for files and pages: independent of the locale, same input, same bytes.

#include <string>

namespace rovigo::app {

/// Fixed notation; never "-0.00". "nan" and "inf" for what is not finite.
std::string fixed(double value, int decimals);

/// For people: lengths below 0.1 m in millimetres, angles in degrees with radians behind.
/// Units known: "m", "rad", "s", "m/s", "rad/s", "%" (value is a share), "" and anything else as
/// is.
std::string quantity(double value, const std::string& unit);

/// Text made safe inside HTML and SVG.
std::string escaped(const std::string& text);

}  // namespace rovigo::app
