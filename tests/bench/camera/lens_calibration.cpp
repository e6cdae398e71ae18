// Calibrates lenses from simulated pictures of a board, as `chorus calibrate camera` does, but
// without files.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "common/calibration/board_finder.h"
#include "common/calibration/verdict.h"
#include "common/synthetic/draw.h"
#include "tests/bench/camera/camera_cases.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/judge/statistics.h"
#include "tests/support/boards/board_scene.h"

namespace chorus::bench {
namespace {

using calibration::Board;
using calibration::PictureSize;

constexpr PictureSize kSize{1280, 720};
constexpr std::size_t kViews = 20;
constexpr double kPercent = 100.0;

/// A random webcam or wide-angle lens.
Intrinsics drawn_lens(std::uint64_t seed) {
  synthetic::Draw draw({seed, 67});
  Intrinsics lens{kSize.width, kSize.height, 0, 0, 0, 0, {}};
  lens.fx = draw.uniform(700.0, 1300.0);
  lens.fy = lens.fx * draw.uniform(0.995, 1.005);
  lens.cx = 0.5 * kSize.width + 20.0 * draw.gauss();
  lens.cy = 0.5 * kSize.height + 20.0 * draw.gauss();
  lens.distortion = {draw.uniform(-0.25, 0.15), draw.uniform(-0.05, 0.1), 0.001 * draw.gauss(),
                     0.001 * draw.gauss(), 0.0};
  return lens;
}

struct Draw {
  double focal_percent = 0.0;  ///< Relative error of fx [percent].
  double centre_px = 0.0;
  double sigmas = 0.0;  ///< Error of fx divided by its stated standard deviation.
  double pixels = 0.0;  ///< Largest error of a direction in the picture [px].
  double reprojection = 0.0;
  double refused = 0.0;
};

/// Largest distance, over the picture, between the pixels of the same direction in the two lenses.
double worst_pixel(const Intrinsics& truth, const Intrinsics& found) {
  double worst = 0.0;
  for (int x = -9; x <= 9; ++x) {
    for (int y = -9; y <= 9; ++y) {
      const Eigen::Vector3d ray(x / 10.0 * truth.cx / truth.fx, y / 10.0 * truth.cy / truth.fy, 1);
      worst =
          std::max(worst, (testing::projected(ray, truth) - testing::projected(ray, found)).norm());
    }
  }
  return worst;
}

Draw run_draw(const Board& board, std::uint64_t seed, const testing::PoseWishes& how) {
  const Intrinsics truth = drawn_lens(seed);
  const testing::BoardCamera camera(board, truth);
  const calibration::BoardFinder finder(board);
  std::vector<calibration::View> views;
  std::uint64_t picture = 1000 * seed;
  for (const auto& pose : testing::board_poses(board, truth, how)) {
    const auto corners = finder.find(camera.picture(pose, {}, ++picture));
    if (!corners.empty()) views.push_back({"", corners});
  }
  const auto found = calibration::calibrate(calibration::varied_views(views, kSize, 40), kSize);
  if (!found) return {NAN, NAN, NAN, NAN, NAN, 1.0};
  const Intrinsics& lens = found->intrinsics;
  return {kPercent * std::abs(lens.fx / truth.fx - 1.0),
          std::hypot(lens.cx - truth.cx, lens.cy - truth.cy),
          std::abs(lens.fx - truth.fx) / found->sigma[0],
          worst_pixel(truth, lens),
          found->error_px,
          calibration::weaknesses(*found).empty() ? 0.0 : 1.0};
}

void add_row(Report& report, const std::string& name, const char* metric, const char* unit,
             const std::vector<Draw>& draws, double Draw::*what) {
  std::vector<double> values;
  for (const Draw& draw : draws) values.push_back(draw.*what);
  constexpr double kLow = 0.05;
  constexpr double kHigh = 0.95;
  Row row{name, metric, median(values), unit, ""};
  row.spread = Spread{row.value, percentile(values, kLow), percentile(values, kHigh),
                      static_cast<std::size_t>(std::ranges::count_if(
                          values, [](double value) { return std::isnan(value); })),
                      values.size()};
  report.row(row);
}

void report_board(Report& report, const std::string& name, const Board& board,
                  testing::PoseWishes how) {
  const std::size_t count = report.quick() ? 2 : 20;
  const auto draws = over_draws(count, [&](std::size_t i) {
    testing::PoseWishes own = how;
    own.seed = report.seed() + i;
    return run_draw(board, own.seed, own);
  });
  add_row(report, name, "focal_length_error", "%", draws, &Draw::focal_percent);
  add_row(report, name, "centre_error", "px", draws, &Draw::centre_px);
  add_row(report, name, "worst_direction", "px", draws, &Draw::pixels);
  add_row(report, name, "error_by_stated_sigma", "1", draws, &Draw::sigmas);
  add_row(report, name, "reprojection", "px", draws, &Draw::reprojection);
  add_row(report, name, "refused", "1", draws, &Draw::refused);
}

}  // namespace

Result<void> lens_calibration(Report& report) {
  Board chessboard;
  chessboard.kind = calibration::BoardKind::Chessboard;
  report_board(report, "calibrate-charuco", Board{}, {.count = kViews});
  report_board(report, "calibrate-chessboard", chessboard,
               {.count = kViews, .share = 0.35, .reach = 0.25});
  report_board(report, "calibrate-flat", Board{}, {.count = kViews, .tilt = 0.05});
  report.note(fmt::format(
      "calibrate: {} rendered pictures of a flat board (simulation: blur 0.7 px, noise 4 of 255), "
      "lenses drawn; calibrate-flat is never tilted, and has to be refused",
      kViews));
  return {};
}

}  // namespace chorus::bench
