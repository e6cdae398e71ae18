// The corners of a board in one picture, and the choice among many pictures.  All functions are
// pure.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

namespace chorus::calibration {

struct Corner {
  Eigen::Vector2d on_board;  ///< [m]
  Eigen::Vector2d pixel;     ///< Centres of pixels are at whole coordinates.
};

struct View {
  std::string name;  ///< Names the picture in messages.
  std::vector<Corner> corners;
};

struct PictureSize {
  int width = 0;
  int height = 0;

  bool operator==(const PictureSize&) const = default;
};

/// At most `most` views, as different from each other as possible in position, size and tilt of the
/// board; in the original order.  Only one is taken of views that hardly differ, for example while
/// the board is held still.
[[nodiscard]] std::vector<View> varied_views(const std::vector<View>& views, PictureSize size,
                                             std::size_t most);

}  // namespace chorus::calibration
