#pragma once
// Little-endian values out of untrusted bytes, as ROS writes them.

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace rovigo::slam {

/// Reads forward and never past the end: once a read does not fit, `ok()` is false for good and
/// every further read gives zero or nothing.
class ByteCursor {
 public:
  explicit ByteCursor(std::string_view bytes) : bytes_(bytes) {}

  bool ok() const { return ok_; }
  std::size_t left() const { return ok_ ? bytes_.size() - at_ : 0; }

  std::string_view take(std::size_t count) {
    if (!ok_ || count > bytes_.size() - at_) {
      ok_ = false;
      return {};
    }
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }

  template <class T>
  T number() {
    static_assert(std::endian::native == std::endian::little, "ROS messages are little-endian");
    const std::string_view raw = take(sizeof(T));
    T value{};
    if (!raw.empty()) std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }

  template <std::size_t kCount>
  std::array<double, kCount> doubles() {
    std::array<double, kCount> values;
    for (double& value : values) value = number<double>();
    return values;
  }

  /// A string or byte array: its length in four bytes, then its bytes.
  std::string_view counted() { return take(number<std::uint32_t>()); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace rovigo::slam
