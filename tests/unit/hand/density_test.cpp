// The density that a file states.
#include "common/hand/density.h"

#include <cstdint>
#include <string>

#include <gtest/gtest.h>

namespace chorus::hand {
namespace {

constexpr double kDpi300 = 300.0 / 0.0254;

std::string number(std::uint32_t value, int size, bool little = false) {
  std::string out;
  for (int i = 0; i < size; ++i) out += static_cast<char>(value >> 8 * (little ? i : size - 1 - i));
  return out;
}

std::string png(std::uint32_t x, std::uint32_t y, char unit) {
  return "\x89PNG\r\n\x1a\n" + number(13, 4) + "IHDR" + std::string(13, '\0') + number(0, 4) +
         number(9, 4) + "pHYs" + number(x, 4) + number(y, 4) + unit + number(0, 4);
}

std::string jpeg(char unit, std::uint32_t density) {
  return "\xFF\xD8\xFF\xE0" + number(16, 2) + std::string("JFIF\0\1\2", 7) + unit +
         number(density, 2) + number(density, 2) + std::string(2, '\0') + "\xFF\xDA";
}

std::string tiff(bool little, std::uint32_t unit) {
  const auto n = [&](std::uint32_t value, int size) { return number(value, size, little); };
  const auto entry = [&](std::uint32_t tag, std::uint32_t type, const std::string& value) {
    return n(tag, 2) + n(type, 2) + n(1, 4) + value;
  };
  std::string out = (little ? "II" : "MM") + n(42, 2) + n(8, 4) + n(3, 2);
  const std::uint32_t values = 8 + 2 + 3 * 12 + 4;
  out += entry(0x011A, 5, n(values, 4)) + entry(0x011B, 5, n(values + 8, 4)) +
         entry(0x0128, 3, n(unit, 2) + n(0, 2)) + n(0, 4);
  for (int i = 0; i < 2; ++i) out += n(3000, 4) + n(10, 4);
  return out;
}

TEST(Density, IsReadFromPngJpegAndTiff) {
  EXPECT_NEAR(pixels_per_metre(png(11811, 11811, 1)).value_or(0), kDpi300, 1.0);
  EXPECT_NEAR(pixels_per_metre(jpeg(1, 300)).value_or(0), kDpi300, 1e-6);
  EXPECT_NEAR(pixels_per_metre(jpeg(2, 118)).value_or(0), 11800.0, 1e-6);
  EXPECT_NEAR(pixels_per_metre(tiff(true, 2)).value_or(0), kDpi300, 1e-6);
  EXPECT_NEAR(pixels_per_metre(tiff(false, 3)).value_or(0), 30000.0, 1e-6);
}

TEST(Density, OfARatioOrOfTwoDensitiesIsNone) {
  EXPECT_FALSE(pixels_per_metre(png(1, 1, 0)));
  EXPECT_FALSE(pixels_per_metre(png(11811, 5000, 1)));
  EXPECT_FALSE(pixels_per_metre(jpeg(0, 1)));
  EXPECT_FALSE(pixels_per_metre(tiff(true, 1)));
}

TEST(Density, OfACutOffFileIsNone) {
  for (const std::string& whole : {png(11811, 11811, 1), jpeg(1, 300), tiff(true, 2)}) {
    for (std::size_t size = 0; size + 16 < whole.size(); ++size)
      (void)pixels_per_metre(whole.substr(0, size));  // reads nothing beyond its end (asan)
  }
  EXPECT_FALSE(pixels_per_metre(""));
  EXPECT_FALSE(pixels_per_metre("\xFF\xD8\xFF\xE0\xFF\xFF"));
}

}  // namespace
}  // namespace chorus::hand
