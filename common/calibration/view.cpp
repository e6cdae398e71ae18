#include "common/calibration/view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

namespace chorus::calibration {
namespace {

/// Two views closer than this add no information: a few hundredths of the picture, or some degrees.
constexpr double kSame = 0.05;

/// How the board appears in the picture: the affine map from board to picture, relative to the
/// picture's width and the board's size (a tilt shortens one direction); how much larger one side
/// of the board appears than the other, which distinguishes a tilt from its opposite; and the
/// centre.
using Look = Eigen::Matrix<double, 8, 1>;

struct Affine {
  Eigen::Vector2d board = Eigen::Vector2d::Zero();  ///< Centre [m].
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d pixel_from_board = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  ///< Scatter matrix of the corners on the
                                                      ///< board [m^2].
};

Affine affine_of(const View& view) {
  Affine out;
  const auto count = static_cast<double>(view.corners.size());
  for (const Corner& corner : view.corners) {
    out.board += corner.on_board / count;
    out.pixel += corner.pixel / count;
  }
  Eigen::Matrix2d both = Eigen::Matrix2d::Zero();
  for (const Corner& corner : view.corners) {
    const Eigen::Vector2d on_board = corner.on_board - out.board;
    out.scatter += on_board * on_board.transpose();
    both += (corner.pixel - out.pixel) * on_board.transpose();
  }
  const Eigen::Matrix2d least = Eigen::Matrix2d::Identity() * 1e-12;  // for corners in a line
  out.pixel_from_board = both * (out.scatter + least).inverse();
  return out;
}

/// g in pixel = (A b) (1 - g.b): how the scale decreases along the board [1/m].
Eigen::Vector2d fall_of(const View& view, const Affine& map) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Identity() * 1e-12;
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (const Corner& corner : view.corners) {
    const Eigen::Vector2d b = corner.on_board - map.board;
    const Eigen::Vector2d flat = map.pixel_from_board * b;
    const Eigen::Vector2d left = corner.pixel - map.pixel - flat;
    normal += flat.squaredNorm() * b * b.transpose();
    right -= left.dot(flat) * b;
  }
  return normal.inverse() * right;
}

Look look_of(const View& view, PictureSize size) {
  constexpr double kAcross = 4.0;  // a board's width in standard deviations of its corners
  const Affine map = affine_of(view);
  const auto count = static_cast<double>(view.corners.size());
  const double extent = kAcross * std::sqrt(map.scatter.trace() / count);
  const Eigen::Matrix2d shape = map.pixel_from_board * (extent / size.width);
  const Eigen::Vector2d centre(map.pixel.x() / size.width, map.pixel.y() / size.height);
  const Eigen::Vector2d fall = 0.5 * extent * fall_of(view, map);
  return (Look() << shape.reshaped(), fall, centre).finished();
}

std::size_t fullest(const std::vector<View>& views) {
  const auto most = std::max_element(views.begin(), views.end(), [](const View& a, const View& b) {
    return a.corners.size() < b.corners.size();
  });
  return static_cast<std::size_t>(most - views.begin());
}

}  // namespace

std::vector<View> varied_views(const std::vector<View>& views, PictureSize size, std::size_t most) {
  if (views.empty() || most == 0) return {};
  std::vector<Look> looks;
  for (const View& view : views) looks.push_back(look_of(view, size));
  std::vector<double> distance(views.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen;
  for (std::size_t next = fullest(views); chosen.size() < most;) {
    chosen.push_back(next);
    for (std::size_t i = 0; i < views.size(); ++i)
      distance[i] = std::min(distance[i], (looks[i] - looks[next]).norm());
    next = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) -
                                    distance.begin());
    if (distance[next] < kSame) break;
  }
  std::sort(chosen.begin(), chosen.end());
  std::vector<View> out;
  for (const std::size_t i : chosen) out.push_back(views[i]);
  return out;
}

}  // namespace chorus::calibration
