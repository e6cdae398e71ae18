#include "common/calibration/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace chorus::calibration {
namespace {

constexpr double kThird = 1.0 / 3.0;
constexpr double kWidest = 0.2;    // smallest focal length relative to the picture's longer side: a
                                   // field of view of 136 degrees
constexpr double kNarrowest = 12;  // 5 degrees

// Errors of the corners, relative to the picture's longer side, that no bent board and no blur
// explain.
constexpr double kAnotherBoard = 0.015;

/// A third of the picture: its name, and the part of a side that it covers.
struct Strip {
  const char* name;
  int axis;  ///< 0: of the width, 1: of the height.
  double begin;
  double end;
};
constexpr std::array kStrips{Strip{"left", 0, 0.0, kThird}, Strip{"right", 0, 2 * kThird, 1.0},
                             Strip{"upper", 1, 0.0, kThird}, Strip{"lower", 1, 2 * kThird, 1.0}};

bool lies_in(const Strip& strip, const Eigen::Vector2d& pixel, PictureSize size) {
  const double place = pixel(strip.axis) / (strip.axis == 0 ? size.width : size.height);
  return place >= strip.begin && place <= strip.end;
}

void find_gaps(const std::vector<const View*>& views, PictureSize size, double share,
               std::vector<std::string>& out) {
  for (const Strip& strip : kStrips) {
    std::size_t inside = 0;
    std::size_t all = 0;
    for (const View* view : views) {
      all += view->corners.size();
      inside += static_cast<std::size_t>(
          std::count_if(view->corners.begin(), view->corners.end(),
                        [&](const Corner& c) { return lies_in(strip, c.pixel, size); }));
    }
    if (static_cast<double>(inside) >= share * static_cast<double>(all) && inside > 0) continue;
    out.push_back(fmt::format("{} board in the {} third of the picture: hold it there too",
                              inside == 0 ? "no" : "hardly any", strip.name));
  }
}

void find_few(std::size_t views, std::size_t least, std::vector<std::string>& out) {
  if (views >= least) return;
  if (views == 0) {
    out.push_back(
        "the board was found in none of them: --squares counts squares, one more each way than "
        "inner corners; --board and --marker-bits must be those of the print; all of a chessboard "
        "must be in the picture, which must be sharp and bright; a board printed white on black is "
        "not found");
    return;
  }
  out.push_back(fmt::format(
      "only {} different view{} of the board, at least {}: move it, turn it, hold it still for a "
      "moment each time",
      views, views == 1 ? "" : "s", least));
}

void find_untilted(const Calibration& calibration, const Demands& demands,
                   std::vector<std::string>& out) {
  const auto tilted = static_cast<std::size_t>(
      std::count_if(calibration.views.begin(), calibration.views.end(),
                    [&](const SolvedView& v) { return v.used && v.tilt >= demands.tilt; }));
  if (tilted >= demands.tilted_views) return;
  out.push_back(
      fmt::format("tilt the board by 30 deg in at least {} views, each another way: {} tilted, "
                  "and without tilt the focal length is unknown",
                  demands.tilted_views,
                  tilted == 0   ? "none is"
                  : tilted == 1 ? "only 1 is"
                                : fmt::format("only {} are", tilted)));
}

void find_bad_fit(const Calibration& calibration, const Demands& demands,
                  std::vector<std::string>& out) {
  const Intrinsics& camera = calibration.intrinsics;
  const double side = std::max(camera.width, camera.height);
  if (!(calibration.error_px <= demands.error_share * side))
    out.push_back(
        fmt::format("the corners miss their places by {:.1f} px, more than {:.1f}: is the "
                    "board flat, are --squares those of the board, are the pictures sharp?",
                    calibration.error_px, demands.error_share * side));
  const double focal = std::max(camera.fx, camera.fy) / side;
  if (!(focal >= kWidest && focal <= kNarrowest))
    out.push_back(
        fmt::format("the focal length comes out as {:.0f} px, which no usual lens has", camera.fx));
  if (!(calibration.focal_sigma() <= demands.focal_sigma))
    out.push_back(
        fmt::format("the focal length is known to {:.1f} % only, not to {:.1f}: more "
                    "tilted views, and the board large in the picture",
                    100.0 * calibration.focal_sigma(), 100.0 * demands.focal_sigma));
}

}  // namespace

std::vector<std::string> weaknesses(const Calibration& calibration, const Demands& demands) {
  const auto& [width, height] =
      std::pair(calibration.intrinsics.width, calibration.intrinsics.height);
  if (calibration.error_px > kAnotherBoard * std::max(width, height))
    return {fmt::format(  // What came out is no lens, so its other faults say nothing.
        "the corners miss their places by {:.0f} px: this is another board than --squares says, "
        "which counts squares, one more each way than inner corners",
        calibration.error_px)};
  std::vector<std::string> out;
  std::vector<const View*> used;
  for (const SolvedView& each : calibration.views) {
    if (each.used) used.push_back(&each.view);
  }
  find_few(used.size(), demands.views, out);
  find_gaps(used, {calibration.intrinsics.width, calibration.intrinsics.height}, demands.share,
            out);
  find_untilted(calibration, demands, out);
  find_bad_fit(calibration, demands, out);
  return out;
}

std::vector<std::string> missing_views(const std::vector<View>& views, PictureSize size,
                                       const Demands& demands) {
  std::vector<std::string> out;
  std::vector<const View*> all;
  for (const View& view : views) all.push_back(&view);
  find_few(views.size(), demands.views, out);
  if (!views.empty()) find_gaps(all, size, demands.share, out);
  return out;
}

}  // namespace chorus::calibration
