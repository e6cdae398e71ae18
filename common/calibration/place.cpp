#include "common/calibration/place.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include "common/base/units.h"
#include "common/calibration/place_fit.h"
#include "common/geometry/rotation.h"
#include "common/sensor/pixel_ray.h"

namespace chorus::calibration {
namespace {

constexpr std::size_t kFewestPoints = 4;
// A board that was moved by less than this stands where it stood [m, rad].
constexpr double kNotMoved = 0.03;
constexpr double kNotTurned = 0.035;
// The mirrored solution is excluded by its fit alone if it is worse by this [variances]: five and a
// half standard deviations, at which 1000 trials accept none.
constexpr double kMirroredWorse = 30.0;
// Corners that are farther from their places than this on average are of something else, as a share
// of the picture's longer side.
constexpr double kNoFit = 0.004;
constexpr double kUnderTheFloor = 0.02;  // [m]

/// camera_from_plane for both solutions; the plane's axes are those of on_board.
std::vector<Eigen::Isometry3d> plane_solutions(const View& sight, const Intrinsics& lens) {
  std::vector<cv::Point3d> plane;
  std::vector<cv::Point2d> seen;
  for (const Corner& corner : sight.corners) {
    const auto ray = ray_of(corner.pixel, lens);
    if (!ray || !(ray->z() > 0.0)) continue;
    plane.emplace_back(corner.on_board.x(), corner.on_board.y(), 0.0);
    seen.emplace_back(ray->x() / ray->z(), ray->y() / ray->z());
  }
  if (plane.size() < kFewestPoints) return {};
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  try {
    cv::solvePnPGeneric(plane, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turns, shifts,
                        false, cv::SOLVEPNP_IPPE);
  } catch (const cv::Exception&) {
    return {};  // All points on a line.
  }
  std::vector<Eigen::Isometry3d> out;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const Eigen::Vector3d turn(turns[i].at<double>(0), turns[i].at<double>(1),
                               turns[i].at<double>(2));
    const Eigen::Vector3d shift(shifts[i].at<double>(0), shifts[i].at<double>(1),
                                shifts[i].at<double>(2));
    if (!turn.allFinite() || !shift.allFinite()) continue;
    out.push_back(Eigen::Translation3d(shift) * exp_map(turn));
  }
  return out;
}

Eigen::Isometry3d world_from_plane(const PlaceQuestion& question) {
  const auto at = [&](double x, double y) { return world_point(question, {x, y}); };
  Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
  out.linear().col(0) = at(1, 0) - at(0, 0);
  out.linear().col(1) = at(0, 1) - at(0, 0);
  out.linear().col(2) = out.linear().col(0).cross(out.linear().col(1));
  out.translation() = at(0, 0);
  return out;
}

/// Where a later sight's board stands on the floor, by the solution that keeps it most upright.
std::optional<MovedBoard> board_in(const PlaceQuestion& question, const View& sight,
                                   const Eigen::Isometry3d& world_from_camera) {
  const Eigen::Isometry3d plane = world_from_plane(question);
  std::optional<MovedBoard> best;
  double best_up = -1.0;
  for (const Eigen::Isometry3d& camera_from_plane : plane_solutions(sight, question.lens)) {
    const Eigen::Isometry3d moved = world_from_camera * camera_from_plane * plane.inverse();
    if (moved.linear()(1, 1) <= best_up) continue;
    best_up = moved.linear()(1, 1);
    MovedBoard board{true, moved.translation().x(), moved.translation().z(),
                     yaw_of(moved.linear())};
    board.moved = std::hypot(board.x, board.z) > kNotMoved || std::abs(board.yaw) > kNotTurned;
    best = board;
  }
  return best;
}

/// The camera's roll: how far its picture's vertical is from the world's [rad].
double roll_of(const Eigen::Isometry3d& world_from_camera) {
  const Eigen::Vector3d up = world_from_camera.linear().transpose() * Eigen::Vector3d::UnitY();
  return std::atan2(up.x(), -up.y());
}

bool stands_well(const PlaceQuestion& question, const PlaceFit& fit) {
  const Eigen::Isometry3d& camera = fit.guess.world_from_camera;
  if (camera.translation().y() < kUnderTheFloor) return false;
  // A camera that looks straight down has no roll.
  constexpr double kDown = 0.94;
  const double down = -camera.linear()(1, 2);
  return down > kDown || std::abs(roll_of(camera)) <= question.largest_roll;
}

std::optional<PlaceFit> fit_from(const PlaceQuestion& question,
                                 const Eigen::Isometry3d& camera_from_plane) {
  PlaceGuess guess;
  guess.world_from_camera = world_from_plane(question) * camera_from_plane.inverse();
  guess.boards.push_back({});
  for (std::size_t i = 1; i < question.sights.size(); ++i) {
    const auto board = board_in(question, question.sights[i], guess.world_from_camera);
    if (!board) return std::nullopt;
    guess.boards.push_back(*board);
  }
  return refine(question, std::move(guess));
}

/// What the noise is larger than stated by [variances].
double excess(const PlaceFit& fit) { return std::max(1.0, fit.squares / fit.freedom); }

CameraPlace told(const PlaceQuestion& question, const PlaceFit& fit) {
  CameraPlace place;
  place.world_from_sensor = fit.guess.world_from_camera;
  place.world_from_sensor.linear() =
      fit.guess.world_from_camera.linear() * camera_from_sensor_axes();
  place.with_focal = excess(fit) * fit.covariance;
  place.covariance = place.with_focal.topLeftCorner<6, 6>();
  place.error_px = fit.error_px;
  place.sights = question.sights.size();
  place.roll = roll_of(fit.guess.world_from_camera);
  return place;
}

Result<void> check(const PlaceQuestion& question) {
  if (question.sights.empty())
    return fail(ErrorCode::InvalidArgument, "sights", "there is none: no picture shows the board");
  for (const View& sight : question.sights) {
    if (sight.corners.size() < kFewestPoints)
      return fail(ErrorCode::InvalidArgument, sight.name,
                  fmt::format("has {} points; at least four are needed, not on one line",
                              sight.corners.size()));
  }
  return {};
}

tl::unexpected<Error> no_fit(const PlaceQuestion& question, const PlaceFit& fit) {
  return fail(
      ErrorCode::InvalidArgument, question.sights.front().name,
      fmt::format("the points are {:.1f} px from where they should be; is the lens that of these "
                  "pictures, and are the board's squares or the marks' places right?",
                  fit.error_px));
}

tl::unexpected<Error> nowhere(const PlaceQuestion& question) {
  return fail(ErrorCode::InvalidArgument, question.sights.front().name,
              fmt::format("no camera above the floor, turned by at most {:.0f} deg, sees the "
                          "points so; does the board {}, and is its upper edge up in the picture?",
                          to_deg(question.largest_roll),
                          question.stance == BoardStance::Lies ? "lie" : "stand"));
}

}  // namespace

Result<CameraPlace> place_of(const PlaceQuestion& question) {
  if (const auto ok = check(question); !ok) return pass(ok);
  std::vector<PlaceFit> fits;
  for (const auto& solution : plane_solutions(question.sights.front(), question.lens)) {
    if (auto fit = fit_from(question, solution)) fits.push_back(std::move(*fit));
  }
  if (fits.empty()) return nowhere(question);
  std::sort(fits.begin(), fits.end(),
            [](const PlaceFit& a, const PlaceFit& b) { return a.squares < b.squares; });
  const double limit = kNoFit * std::max(question.lens.width, question.lens.height);
  if (!(fits.front().error_px < limit)) return no_fit(question, fits.front());
  const double scale = excess(fits.front());
  std::erase_if(fits, [&](const PlaceFit& fit) { return !stands_well(question, fit); });
  if (fits.empty()) return nowhere(question);
  CameraPlace place = told(question, fits.front());
  if (fits.size() < 2) return place;
  const double apart = (fits[1].guess.world_from_camera.translation() -
                        fits[0].guess.world_from_camera.translation())
                           .norm();
  const double turned =
      angular_distance(Eigen::Quaterniond(fits[0].guess.world_from_camera.linear()),
                       Eigen::Quaterniond(fits[1].guess.world_from_camera.linear()));
  // Both guesses have come to the same place.
  constexpr double kSame = 1e-3;
  if (apart < kSame && turned < kSame) return place;
  place.mirrored_worse = (fits[1].squares - fits[0].squares) / scale;
  if (*place.mirrored_worse > kMirroredWorse) return place;
  return fail(ErrorCode::Conflict, question.sights.front().name,
              fmt::format("two places fit, {:.0f} mm and {:.1f} deg apart, because the board is "
                          "seen small or straight on: bring it nearer, use a larger one, show it "
                          "in several places, or state the camera's height",
                          to_mm(apart), to_deg(turned)));
}

}  // namespace chorus::calibration
