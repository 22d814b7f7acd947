#include "slam/recording/jpeg_decoder.h"

#include <csetjmp>
#include <cstdio>

extern "C" {
#include <jpeglib.h>
}

namespace rovigo::slam {
namespace {

struct ErrorHandler {
  jpeg_error_mgr base;  // first, as libjpeg hands out a pointer to it
  std::jmp_buf escape;
};

void escape_on_error(j_common_ptr state) {
  std::longjmp(reinterpret_cast<ErrorHandler*>(state->err)->escape, 1);
}

/// Warnings (negative levels) mean that pixels were made up.
void escape_on_warning(j_common_ptr state, int level) {
  if (level < 0) escape_on_error(state);
}

void keep_quiet(j_common_ptr) {}

/// Nothing here may need a destructor: longjmp runs none.
bool decode_into(jpeg_decompress_struct& jpeg, ErrorHandler& handler, std::string_view bytes,
                 cv::Mat& image) {
  if (setjmp(handler.escape) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&jpeg, TRUE);
  jpeg.out_color_space = JCS_EXT_BGR;
  jpeg_start_decompress(&jpeg);
  if (static_cast<int>(jpeg.output_width) != image.cols ||
      static_cast<int>(jpeg.output_height) != image.rows || jpeg.output_components != 3) {
    return false;
  }
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = image.ptr<unsigned char>(static_cast<int>(jpeg.output_scanline));
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return true;
}

}  // namespace

cv::Mat decode_jpeg(std::string_view bytes, int width, int height, std::string& problem) {
  cv::Mat image(height, width, CV_8UC3);
  jpeg_decompress_struct jpeg = {};
  ErrorHandler handler = {};
  jpeg.err = jpeg_std_error(&handler.base);
  handler.base.error_exit = escape_on_error;
  handler.base.emit_message = escape_on_warning;
  handler.base.output_message = keep_quiet;
  const bool decoded = decode_into(jpeg, handler, bytes, image);
  jpeg_destroy_decompress(&jpeg);
  if (decoded) return image;
  problem = "a damaged JPEG";
  return {};
}

}  // namespace rovigo::slam
