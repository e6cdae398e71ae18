#include "common/calibration/exif.h"

#include <string>

#include <gtest/gtest.h>

namespace chorus::calibration {
namespace {

/// A number of `size` bytes, little-endian if `little`.
std::string bytes(std::uint32_t value, int size, bool little) {
  std::string out;
  for (int i = 0; i < size; ++i) {
    const int shift = 8 * (little ? i : size - 1 - i);
    out += static_cast<char>((value >> shift) & 0xFFU);
  }
  return out;
}

/// The beginning of a JPEG, with one directory that points to Exif's, which contains the focal
/// length.
std::string photo(std::uint32_t focal, bool little) {
  const auto n = [&](std::uint32_t value, int size) { return bytes(value, size, little); };
  std::string tiff = (little ? "II" : "MM") + n(42, 2) + n(8, 4);
  tiff += n(1, 2) + n(0x8769, 2) + n(4, 2) + n(1, 4) + n(26, 4) + n(0, 4);
  tiff += n(1, 2) + n(0xA405, 2) + n(3, 2) + n(1, 4) + n(focal, 2) + n(0, 2) + n(0, 4);
  const std::string body = std::string("Exif\0\0", 6) + tiff;
  return std::string("\xFF\xD8\xFF\xE0\x00\x04zz\xFF\xE1", 10) +
         bytes(static_cast<std::uint32_t>(body.size() + 2), 2, false) + body;
}

TEST(Exif, TheFocalLengthIsReadInEitherByteOrder) {
  EXPECT_EQ(focal_on_35mm_film(photo(26, true)), 26.0);
  EXPECT_EQ(focal_on_35mm_film(photo(26, false)), 26.0);
}

TEST(Exif, PhotosThatDoNotSayOrAreCutOffHaveNone) {
  EXPECT_FALSE(focal_on_35mm_film(""));
  EXPECT_FALSE(focal_on_35mm_film("\xFF\xD8\xFF\xDA"));
  EXPECT_FALSE(focal_on_35mm_film(photo(0, true)));
  const std::string whole = photo(26, true);
  for (std::size_t size = 0; size + 6 < whole.size(); ++size)
    EXPECT_FALSE(focal_on_35mm_film(whole.substr(0, size))) << size;
}

TEST(Exif, AFocalLengthOnFilmBecomesPixelsByTheDiagonal) {
  // 50 mm on 36 x 24 mm is 46.8 degrees across the diagonal.
  EXPECT_NEAR(pixels_of_35mm(50.0, 3000, 2000), 50.0 / 36.0 * 3000.0, 1e-9);
}

}  // namespace
}  // namespace chorus::calibration
