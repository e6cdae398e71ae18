#include "common/hand/density.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace chorus::hand {
namespace {

constexpr double kInchesPerMetre = 1.0 / 0.0254;
constexpr double kSame = 0.01;  // Densities across and down may differ by their rounding.

/// Numbers in bytes; what lies beyond the end is 0.
class Bytes {
 public:
  Bytes(std::string_view bytes, bool little) : bytes_(bytes), little_(little) {}

  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    if (at > bytes_.size() || size > bytes_.size() - at) return 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t from = little_ ? size - 1 - i : i;
      value = (value << 8) | static_cast<unsigned char>(bytes_[at + from]);
    }
    return value;
  }

 private:
  std::string_view bytes_;
  bool little_;
};

std::optional<double> one_of(double across, double down) {
  if (!(across > 0.0) || !(down > 0.0) || std::abs(across - down) > kSame * down)
    return std::nullopt;
  return 0.5 * (across + down);
}

/// PNG specification, 11.3.5.3: pixels per unit, x and y, and 1 if the unit is the metre.
std::optional<double> of_png(std::string_view png) {
  const Bytes bytes(png, false);
  for (std::size_t at = 8; at + 12 <= png.size();) {
    const std::size_t length = bytes.number(at, 4);
    const std::string_view kind = png.substr(at + 4, 4);
    if (kind == "pHYs" && bytes.number(at + 16, 1) == 1)
      return one_of(bytes.number(at + 8, 4), bytes.number(at + 12, 4));
    if (kind == "IDAT" || length > png.size()) break;
    at += 12 + length;
  }
  return std::nullopt;
}

/// TIFF 6.0: XResolution and YResolution (rationals), ResolutionUnit 2: inch, 3: centimetre.
std::optional<double> of_tiff(std::string_view tiff) {
  const Bytes bytes(tiff, tiff.starts_with("II"));
  const std::size_t folder = bytes.number(4, 4);
  const std::uint32_t entries = bytes.number(folder, 2);
  double x = 0.0, y = 0.0;
  std::uint32_t unit = 2;
  for (std::uint32_t i = 0; i < entries && i < 512; ++i) {
    const std::size_t at = folder + 2 + 12 * static_cast<std::size_t>(i);
    const std::uint32_t tag = bytes.number(at, 2);
    const std::size_t value = bytes.number(at + 8, 4);
    const double below = bytes.number(value + 4, 4);
    const double ratio = below > 0.0 ? bytes.number(value, 4) / below : 0.0;
    if (tag == 0x011A) x = ratio;
    if (tag == 0x011B) y = ratio;
    if (tag == 0x0128) unit = bytes.number(at + 8, 2);
  }
  const auto density = one_of(x, y);
  if (!density || (unit != 2 && unit != 3)) return std::nullopt;
  return *density * (unit == 2 ? kInchesPerMetre : 100.0);
}

/// JFIF 1.02, APP0: unit 1: per inch, 2: per centimetre; else the Exif of APP1.
std::optional<double> of_jpeg(std::string_view jpeg) {
  const Bytes bytes(jpeg, false);
  for (std::size_t at = 2; bytes.number(at, 1) == 0xFF && bytes.number(at + 1, 1) != 0xDA;) {
    const std::size_t length = bytes.number(at + 2, 2);
    if (length < 2 || at + 4 > jpeg.size()) break;
    const std::string_view body = jpeg.substr(at + 4, length - 2);
    if (body.starts_with(std::string_view("JFIF\0", 5))) {
      const std::uint32_t unit = bytes.number(at + 11, 1);
      const auto density = one_of(bytes.number(at + 12, 2), bytes.number(at + 14, 2));
      if (density && unit == 1) return *density * kInchesPerMetre;
      if (density && unit == 2) return *density * 100.0;
    }
    if (body.starts_with(std::string_view("Exif\0\0", 6))) {
      if (const auto density = of_tiff(body.substr(6))) return density;
    }
    at += 2 + length;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> pixels_per_metre(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG")) return of_png(bytes);
  if (bytes.starts_with("\xFF\xD8")) return of_jpeg(bytes);
  if (bytes.starts_with("II*") || bytes.starts_with("MM")) return of_tiff(bytes);
  return std::nullopt;
}

}  // namespace chorus::hand
