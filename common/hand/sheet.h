// Things of known size in a picture: a whole sheet of A4, a bank card.
#pragma once

#include <array>
#include <optional>

#include "common/hand/hand.h"

namespace cv {
class Mat;
}

namespace chorus::hand {

/// ISO 216 A4 and ISO/IEC 7810 ID-1 [mm].
inline constexpr double kSheetLong = 297.0;
inline constexpr double kSheetShort = 210.0;
inline constexpr double kCardLong = 85.60;
inline constexpr double kCardShort = 53.98;

/// True if the picture's sides are those of A4: the scan of a whole sheet.
[[nodiscard]] bool has_sides_of_a4(int width, int height);

/// The corners of a bright sheet that lies wholly in the picture, clockwise; a hand may cover a
/// part of its edges.
[[nodiscard]] std::optional<std::array<Pixel, 4>> find_sheet(const cv::Mat& bgr);

/// The sheet as a scanner would see it, with its longer side as long as `side` pixels.
[[nodiscard]] cv::Mat flattened(const cv::Mat& bgr, const std::array<Pixel, 4>& sheet, int side);

struct Card {
  std::array<Pixel, 4> corners{};
  double mm_per_pixel = 0.0;
};

/// A bank card that lies beside the hand, not on or under it.
[[nodiscard]] std::optional<Card> find_card(const cv::Mat& bgr);

/// The picture with the card painted over in the colour of what surrounds it.
[[nodiscard]] cv::Mat without_card(const cv::Mat& bgr, const Card& card);

}  // namespace chorus::hand
