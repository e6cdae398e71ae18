#include "services/sensor/device/scan/photo_scan.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "common/hand/bvh.h"
#include "common/hand/htr.h"
#include "services/sensor/device/camera/shipped_runner.h"
#include "services/sensor/device/scan/hand_scan.h"

namespace chorus::scan {
namespace {

constexpr std::string_view kPng = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpeg = "\xff\xd8\xff";
constexpr double kMostPixels = 60.0e6;  // What phones take, and no more memory than 200 MB.

/// A big-endian number of `size` bytes; 0 behind the end.
std::uint32_t number_at(std::string_view bytes, std::size_t at, std::size_t size) {
  if (at + size > bytes.size()) return 0;
  std::uint32_t out = 0;
  for (std::size_t i = at; i < at + size; ++i)
    out = out << 8 | static_cast<unsigned char>(bytes[i]);
  return out;
}

/// Width times height as the file states them; 0 if it does not.
double pixels_of_png(std::string_view bytes) {
  return 1.0 * number_at(bytes, 16, 4) * number_at(bytes, 20, 4);
}

/// From the first frame header (SOF0 to SOF15 without DHT, JPG and DAC).
double pixels_of_jpeg(std::string_view bytes) {
  std::size_t at = 2;
  while (at + 9 < bytes.size() && number_at(bytes, at, 1) == 0xff) {
    const std::uint32_t marker = number_at(bytes, at + 1, 1);
    const bool other = marker == 0xc4 || marker == 0xc8 || marker == 0xcc;
    if (marker >= 0xc0 && marker <= 0xcf && !other)
      return 1.0 * number_at(bytes, at + 5, 2) * number_at(bytes, at + 7, 2);
    at += 2 + std::max<std::size_t>(2, number_at(bytes, at + 2, 2));
  }
  return 0.0;
}

/// A small file may unfold to gigabytes; so its size is asked first.
Result<ScanSource> source_of(const Photo& photo) {
  const bool png = photo.bytes.starts_with(kPng);
  if (!png && !photo.bytes.starts_with(kJpeg))
    return fail(ErrorCode::Unsupported, "photo", "send a JPEG or PNG");
  const double stated = png ? pixels_of_png(photo.bytes) : pixels_of_jpeg(photo.bytes);
  if (stated > kMostPixels)
    return fail(ErrorCode::TooLarge, "photo", "send at most 60 million pixels");
  auto pixels = std::make_shared<cv::Mat>();
  try {
    const std::vector<unsigned char> bytes(photo.bytes.begin(), photo.bytes.end());
    if (stated > 0.0) *pixels = cv::imdecode(bytes, cv::IMREAD_COLOR);
  } catch (const cv::Exception&) {
    pixels->release();
  }
  if (pixels->empty()) return fail(ErrorCode::Malformed, "photo", "is no picture that can be read");
  const camera::Size size{pixels->cols, pixels->rows};
  return ScanSource{"photo", photo.bytes, {std::move(pixels), size}};
}

class PhotoScan {
 public:
  Result<PhotoAnswer> operator()(const Photo& photo) {
    const auto source = source_of(photo);
    if (!source) return pass(source);
    HandScan how;
    if (photo.scale == "a4") how.scale = ScaleBy::A4;
    if (photo.scale == "card") how.scale = ScaleBy::Card;
    how.options.back = photo.back;
    start();
    auto hand = scan_picture(*source, how, finder_ ? &*finder_ : nullptr);
    if (!hand) {
      // A runner that has died is started again with the next photo.
      if (hand.error().code == ErrorCode::Unavailable) finder_.reset();
      return pass(hand);
    }
    if (!finder_) hand->shape.notes.push_back("without a network: " + without_);
    std::vector<unsigned char> jpeg;
    if (!cv::imencode(".jpg", *hand->drawn, jpeg))
      return fail(ErrorCode::Internal, "photo", "the annotated picture could not be encoded");
    return PhotoAnswer{hand::bvh_of(hand->skeleton),
                       hand::htr_of(hand->skeleton),
                       hand::scan_json(hand->shape, hand->skeleton, hand->record),
                       {jpeg.begin(), jpeg.end()}};
  }

 private:
  void start() {
    if (finder_) return;
    camera::CameraSettings settings;
    settings.model = "hands";
    const auto command = camera::runner_command(settings);
    auto finder = command ? camera::HandFinder::start(*command)
                          : Result<camera::HandFinder>(tl::unexpected<Error>(command.error()));
    if (finder) {
      finder_ = std::move(*finder);
    } else {
      without_ = to_string(finder.error());
    }
  }

  std::optional<camera::HandFinder> finder_;
  std::string without_;
};

}  // namespace

ScanPhoto photo_scan() {
  return [scan = std::make_shared<PhotoScan>()](const Photo& photo) { return (*scan)(photo); };
}

}  // namespace chorus::scan
