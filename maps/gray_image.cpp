#include "maps/gray_image.h"

#include <zlib.h>

#include <cctype>
#include <opencv2/imgcodecs.hpp>

#include "maps/error.h"

namespace rovigo::maps {
namespace {

[[noreturn]] void fail(const std::string& name, const std::string& why) {
  throw InputError(name + ": " + why);
}

std::string size_problem(std::int64_t width, std::int64_t height) {
  const bool fits = width > 0 && height > 0 && width <= kMaxGridSide && height <= kMaxGridSide &&
                    static_cast<std::size_t>(width * height) <= kMaxGridCells;
  if (fits) return {};
  return "claims " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels; a map has 1 to " + std::to_string(kMaxGridSide) + " on each side and at most " +
         std::to_string(kMaxGridCells) + " in all";
}

/// Reads the whitespace-separated numbers of a PGM, passing over comments.
class PgmScanner {
 public:
  PgmScanner(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::int64_t number(const char* what) {
    skip_space_and_comments();
    if (at_ >= bytes_.size()) fail(name_, std::string("the file ends before its ") + what);
    std::int64_t value = 0;
    const std::size_t begin = at_;
    for (; at_ < bytes_.size() && is_digit(bytes_[at_]) && at_ - begin < 10; ++at_) {
      value = 10 * value + (bytes_[at_] - '0');
    }
    if (at_ == begin || (at_ < bytes_.size() && is_digit(bytes_[at_]))) {
      fail(name_, std::string(what) + " is no whole number at byte " + std::to_string(begin));
    }
    return value;
  }
  /// The rest, after the single whitespace character that ends a P5 header.
  std::string_view rest() const {
    return at_ + 1 <= bytes_.size() ? bytes_.substr(at_ + 1) : std::string_view{};
  }
  void skip(std::size_t count) { at_ += count; }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  void skip_space_and_comments() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        while (at_ < bytes_.size() && bytes_[at_] != '\n') ++at_;
      } else if (std::isspace(static_cast<unsigned char>(bytes_[at_]))) {
        ++at_;
      } else {
        return;
      }
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

GrayImage decode_pgm(std::string_view bytes, const std::string& name) {
  const bool binary = bytes[1] == '5';
  PgmScanner scanner(bytes, name);
  scanner.skip(2);
  const std::int64_t width = scanner.number("width");
  const std::int64_t height = scanner.number("height");
  if (const auto problem = size_problem(width, height); !problem.empty()) fail(name, problem);
  const std::int64_t max_value = scanner.number("largest value");
  if (max_value < 1 || max_value > 65535) {
    fail(name, "its largest value is " + std::to_string(max_value) + ", outside 1 .. 65535");
  }
  GrayImage image{
      static_cast<int>(width), static_cast<int>(height), static_cast<int>(max_value), {}, {}};
  const auto count = static_cast<std::size_t>(width * height);
  const std::size_t bytes_per_pixel = max_value > 255 ? 2 : 1;
  const std::string_view data = scanner.rest();
  // Text needs at least a digit and a space for each pixel: check before taking the memory.
  const std::size_t least = binary ? count * bytes_per_pixel : 2 * count - 1;
  if (data.size() < least) {
    fail(name, "is cut off: " + std::to_string(width) + " x " + std::to_string(height) +
                   " pixels need " + std::to_string(least) + " bytes, it has " +
                   std::to_string(data.size()));
  }
  image.pixels.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t value = 0;
    if (!binary) {
      value = scanner.number("pixel");
    } else if (bytes_per_pixel == 1) {
      value = static_cast<std::uint8_t>(data[i]);
    } else {
      value =
          256 * static_cast<std::uint8_t>(data[2 * i]) + static_cast<std::uint8_t>(data[2 * i + 1]);
    }
    if (value > max_value) {
      fail(name, "pixel " + std::to_string(i) + " is " + std::to_string(value) +
                     ", above the largest value " + std::to_string(max_value));
    }
    image.pixels[i] = static_cast<std::uint16_t>(value);
  }
  return image;
}

constexpr std::string_view kPngStart("\x89PNG\r\n\x1a\n", 8);

std::int64_t big_endian_32(std::string_view bytes, std::size_t at) {
  std::int64_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = 256 * value + static_cast<std::uint8_t>(bytes[at + i]);
  }
  return value;
}

template <class Sample>
void average_channels(const cv::Mat& mat, GrayImage& image) {
  const int channels = mat.channels();
  const int colors = channels == 2 || channels == 4 ? channels - 1 : channels;
  for (int y = 0; y < mat.rows; ++y) {
    const Sample* row = mat.ptr<Sample>(y);
    for (int x = 0; x < mat.cols; ++x, row += channels) {
      unsigned sum = 0;
      for (int c = 0; c < colors; ++c) sum += row[c];
      const auto n = static_cast<unsigned>(colors);
      image.pixels.push_back(static_cast<std::uint16_t>((sum + n / 2) / n));
      if (colors < channels) image.is_opaque.push_back(row[colors] == image.max_value);
    }
  }
}

GrayImage decode_png(std::string_view bytes, const std::string& name) {
  if (const auto problem = png_problem(bytes); !problem.empty()) fail(name, problem);
  const std::vector<std::uint8_t> buffer(bytes.begin(), bytes.end());
  cv::Mat mat;
  try {
    mat = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    mat.release();
  }
  if (mat.empty()) fail(name, "is a damaged or cut-off PNG");
  GrayImage image{mat.cols, mat.rows, mat.depth() == CV_16U ? 65535 : 255, {}, {}};
  image.pixels.reserve(mat.total());
  if (mat.depth() == CV_16U) {
    average_channels<std::uint16_t>(mat, image);
  } else if (mat.depth() == CV_8U) {
    average_channels<std::uint8_t>(mat, image);
  } else {
    fail(name, "is a PNG of neither 8 nor 16 bits");
  }
  return image;
}

}  // namespace

std::string png_problem(std::string_view bytes) {
  if (bytes.substr(0, kPngStart.size()) != kPngStart) return "is no PNG image";
  if (bytes.size() < 33) return "is cut off inside the PNG header";
  if (auto problem = size_problem(big_endian_32(bytes, 16), big_endian_32(bytes, 20));
      !problem.empty()) {
    return problem;
  }
  // Chunks: length, type, data, CRC-32 of type and data.
  std::size_t at = kPngStart.size();
  while (bytes.size() - at >= 12) {
    const auto length = static_cast<std::size_t>(big_endian_32(bytes, at));
    if (length > bytes.size() - at - 12) break;
    const std::string_view type_and_data = bytes.substr(at + 4, 4 + length);
    const auto crc =
        ::crc32_z(0, reinterpret_cast<const Bytef*>(type_and_data.data()), type_and_data.size());
    if (static_cast<std::int64_t>(crc) != big_endian_32(bytes, at + 8 + length)) {
      return "is a damaged PNG (a checksum does not match)";
    }
    if (type_and_data.substr(0, 4) == "IEND") return {};
    at += 12 + length;
  }
  return "is a PNG that is cut off";
}

GrayImage decode_gray_image(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) fail(name, "is empty");
  if (bytes.substr(0, 2) == "P5" || bytes.substr(0, 2) == "P2") return decode_pgm(bytes, name);
  if (bytes.substr(0, kPngStart.size()) == kPngStart) return decode_png(bytes, name);
  fail(name, "is neither a PGM (P2, P5) nor a PNG image; convert it to one of them");
}

std::string encode_pgm(int width, int height, const std::vector<std::uint8_t>& pixels,
                       const std::string& comment) {
  std::string bytes = "P5\n";
  if (!comment.empty()) bytes += "# " + comment + "\n";
  bytes += std::to_string(width) + " " + std::to_string(height) + "\n255\n";
  bytes.append(pixels.begin(), pixels.end());
  return bytes;
}

}  // namespace rovigo::maps
