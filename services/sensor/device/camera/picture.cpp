#include "services/sensor/device/camera/picture.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace chorus::camera {

namespace {

/// Whether the file begins like a picture in HEIF, as phones take them (ISO/IEC 23008-12): a box
/// "ftyp" with one of the brands of HEVC or of any HEIF.
bool is_heif(const std::string& file) {
  std::array<char, 12> head{};
  std::ifstream(file, std::ios::binary).read(head.data(), head.size());
  const std::string_view brand(head.data() + 4, 8);
  constexpr std::array<std::string_view, 6> kBrands{"ftypheic", "ftypheix", "ftyphevc",
                                                    "ftypheim", "ftypheis", "ftypmif1"};
  return std::find(kBrands.begin(), kBrands.end(), brand) != kBrands.end();
}

}  // namespace

Result<Picture> read_picture(const std::string& file) {
  std::error_code unknown;
  if (std::filesystem::exists(file, unknown) && !std::filesystem::is_regular_file(file, unknown))
    return fail(ErrorCode::InvalidArgument, file, "is no file; name a picture");
  auto pixels = std::make_shared<cv::Mat>();
  try {
    *pixels = cv::imread(file, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    pixels->release();
  }
  if (pixels->empty() && is_heif(file))
    return fail(ErrorCode::Unsupported, file,
                "is a photo in HEIC, which is not read here; convert it: heif-convert IN.HEIC "
                "OUT.jpg (package libheif-examples), or have the phone take JPEG (iOS: Settings, "
                "Camera, Formats, Most Compatible)");
  if (pixels->empty()) return fail(ErrorCode::Malformed, file, "is no picture that can be read");
  const Size size{pixels->cols, pixels->rows};
  return Picture{std::move(pixels), size};
}

std::string rgb_bytes(const Picture& picture, Size size) {
  constexpr std::size_t kChannels = 3;
  cv::Mat small = *picture.pixels;
  if (picture.size != size)
    cv::resize(*picture.pixels, small, {size.width, size.height}, 0.0, 0.0, cv::INTER_AREA);
  std::string bytes(kChannels * static_cast<std::size_t>(size.width * size.height), '\0');
  cv::Mat rgb(size.height, size.width, CV_8UC3, bytes.data());
  cv::cvtColor(small, rgb, cv::COLOR_BGR2RGB);
  return bytes;
}

Result<std::string> jpeg_of(const Picture& picture) {
  constexpr int kQuality = 85;
  std::vector<uchar> bytes;
  if (!cv::imencode(".jpg", *picture.pixels, bytes, {cv::IMWRITE_JPEG_QUALITY, kQuality}))
    return fail(ErrorCode::Internal, "image", "the picture could not be encoded");
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace chorus::camera
