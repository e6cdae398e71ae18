#include "common/calibration/exif.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace chorus::calibration {
namespace {

constexpr std::string_view kExif("Exif\0\0", 6);
constexpr std::uint32_t kExifFolder = 0x8769;   // tag: offset of the directory of Exif
constexpr std::uint32_t kFocalOn35mm = 0xA405;  // tag
constexpr double kFilmWidth = 36.0;             // [mm]
constexpr double kFilmHeight = 24.0;

/// A TIFF file: reads numbers in the file's byte order; numbers beyond its end are 0.
class Tiff {
 public:
  explicit Tiff(std::string_view bytes) : bytes_(bytes), little_(bytes.starts_with("II")) {}

  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    if (at > bytes_.size() || size > bytes_.size() - at) return 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = little_ ? size - 1 - i : i;
      value = (value << 8) | static_cast<unsigned char>(bytes_[at + from]);
    }
    return value;
  }

  /// The value of the tag `wanted` in the directory (IFD) that begins at the offset `folder`; none
  /// if it is absent.
  [[nodiscard]] std::optional<std::uint32_t> tag(std::uint32_t folder, std::uint32_t wanted) const {
    constexpr std::size_t kEntry = 12;
    constexpr std::uint32_t kShort = 3;
    const std::uint32_t entries = number(folder, 2);
    for (std::uint32_t i = 0; i < entries; ++i) {
      const std::size_t at = folder + 2 + i * kEntry;
      if (number(at, 2) != wanted) continue;
      return number(at + 8, number(at + 2, 2) == kShort ? 2 : 4);
    }
    return std::nullopt;
  }

 private:
  std::string_view bytes_;
  bool little_;
};

/// The TIFF file inside a JPEG; empty if there is none.
std::string_view tiff_in(std::string_view jpeg) {
  constexpr unsigned char kApp1 = 0xE1;
  constexpr unsigned char kScan = 0xDA;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(jpeg[at]); };
  std::size_t at = 2;
  if (!jpeg.starts_with("\xFF\xD8")) return {};
  while (at + 4 <= jpeg.size() && byte(at) == 0xFF && byte(at + 1) != kScan) {
    const std::size_t length = byte(at + 2) * 256u + byte(at + 3);
    const std::string_view body = jpeg.substr(at + 4, length < 2 ? 0 : length - 2);
    if (byte(at + 1) == kApp1 && body.starts_with(kExif)) return body.substr(kExif.size());
    at += 2 + length;
  }
  return {};
}

}  // namespace

std::optional<double> focal_on_35mm_film(std::string_view jpeg) {
  const Tiff tiff(tiff_in(jpeg));
  const auto exif = tiff.tag(tiff.number(4, 4), kExifFolder);
  const auto focal = exif ? tiff.tag(*exif, kFocalOn35mm) : std::nullopt;
  if (!focal || *focal == 0) return std::nullopt;
  return static_cast<double>(*focal);
}

double pixels_of_35mm(double focal_mm, int width, int height) {
  return focal_mm * std::hypot(width, height) / std::hypot(kFilmWidth, kFilmHeight);
}

}  // namespace chorus::calibration
