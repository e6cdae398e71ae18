#include "tests/bench/camera/one_left.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <Eigen/LU>

#include "common/base/units.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/camera/camera_cases.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr std::array kTorso{JointId::ShoulderLeft, JointId::ShoulderRight, JointId::HipLeft,
                            JointId::HipRight};
constexpr double kLeap = 0.3;          // [m] by which a place moves more than the person did
constexpr double kBefore = 0.5;        // [s] before a window over which the error is averaged
constexpr double kInside95 = 7.815;    // 95 % of chi-squared with three degrees of freedom
constexpr double kSettledAfter = 1.0;  // [s] after a window, when all cameras are judged again

/// The middle of shoulders and hips, as far as known, and how it errs.
struct Placed {
  bool seen = false;
  Eigen::Vector3d off = Eigen::Vector3d::Zero();  ///< From the true middle [m].
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double joints = 0.0;  ///< Mean distance of the twelve joints of limbs and torso [m].
};

Placed placed(const FusedBody& body, const Skeleton<WorldSpace>& truth) {
  Placed place;
  double count = 0.0;
  for (const JointId id : kTorso) {
    const Joint& joint = body.skeleton[id];
    if (!joint.seen() || !truth[id].seen()) continue;
    place.off += joint.position - truth[id].position;
    place.covariance += joint.covariance.matrix();
    count += 1.0;
  }
  // One error moves them all, so the mean is as uncertain as each of them.
  place.seen = count > 0;
  if (place.seen) place = {true, place.off / count, place.covariance / count, 0.0};
  std::vector<double> distances;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Joint& joint = body.skeleton.joints[j];
    if (!joint.seen() || !truth.joints[j].seen()) continue;
    distances.push_back((joint.position - truth.joints[j].position).norm());
  }
  for (const double each : distances) place.joints += each / static_cast<double>(distances.size());
  return place;
}

/// Every instant of a take; and the ids that were published.
struct Course {
  std::vector<Placed> places;
  std::set<std::uint64_t> ids;
};

Result<Course> course_of(const LeftTake& take, const std::vector<registration::WalkTrack>& tracks) {
  pipeline::OfflineConfig config;  // as shipped
  config.rate_hz = take.rate_hz;
  const auto result = pipeline::fuse_offline(tracks, take.places, config);
  if (!result) return pass(result);
  Course course{std::vector<Placed>(take.truth.size()), {}};
  for (const Snapshot& snapshot : result->snapshots) {
    const double at = seconds(snapshot.instant - importers::kDefaultStart) * take.rate_hz;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    for (const FusedBody& body : snapshot.bodies) course.ids.insert(body.id.value);
    if (index >= course.places.size() || snapshot.bodies.empty()) continue;
    course.places[index] = placed(snapshot.bodies.front(), take.truth[index]);
  }
  return course;
}

struct Window {
  double begin = 0.0;  ///< [s]
  double end = 0.0;
  std::size_t left = 0;  ///< Index of the camera.
};

std::vector<Window> windows_of(const LeftTake& take, const Withholding& when, std::size_t turn) {
  std::vector<Window> windows;
  const double length = static_cast<double>(take.truth.size()) / take.rate_hz;
  for (double begin = when.first; begin + when.lasts < length; begin += when.every)
    windows.push_back({begin, begin + when.lasts,
                       when.only.value_or((windows.size() + turn) % take.tracks.size())});
  return windows;
}

std::vector<registration::WalkTrack> withheld(const LeftTake& take,
                                              const std::vector<Window>& windows) {
  auto tracks = take.tracks;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    for (SensorFrame& frame : tracks[t].frames) {
      const double at = seconds(frame.captured - importers::kDefaultStart);
      const bool lost = std::ranges::any_of(windows, [&](const Window& each) {
        return each.left != t && at >= each.begin && at < each.end;
      });
      if (lost) frame.bodies.clear();
    }
  }
  return tracks;
}

/// What is measured of all windows of a take.
struct Left {
  std::vector<double> half;  ///< Error of the place half way through a window [m].
  std::vector<double> end;   ///< At its end [m].
  std::vector<double>
      stated;  ///< Stated standard deviation there, in the worst direction's plane [m].
  std::vector<double> growth;   ///< Of the error, since before the window [m/s].
  std::vector<double> joints;   ///< Mean error of joints in a window [m].
  std::vector<double> outside;  ///< The same while all cameras see the person [m].
  double inside = 0.0;          ///< Instants of windows in the stated 95 % region.
  double answered = 0.0;
  double asked = 0.0;
  double leaps = 0.0;
  double ids = 0.0;
};

double error_over(const Course& course, double from, double to, double rate) {
  double sum = 0.0;
  double count = 0.0;
  for (auto i = static_cast<std::size_t>(std::max(0.0, std::ceil(from * rate)));
       i < course.places.size() && static_cast<double>(i) < to * rate; ++i) {
    if (!course.places[i].seen) continue;
    sum += course.places[i].off.norm();
    count += 1.0;
  }
  return count > 0 ? sum / count : kNoRatio;
}

void add_window(Left& left, const Course& course, const Window& window, double rate) {
  const double last = 0.1;  // [s] over which an error is averaged
  const double length = window.end - window.begin;
  const double before = error_over(course, window.begin - kBefore, window.begin, rate);
  const double end = error_over(course, window.end - last, window.end, rate);
  const double middle = window.begin + length / 2;
  left.half.push_back(error_over(course, middle - last, middle, rate));
  left.end.push_back(end);
  left.growth.push_back((end - before) / length);
  for (auto i = static_cast<std::size_t>(std::ceil(window.begin * rate));
       static_cast<double>(i) < window.end * rate; ++i) {
    const Placed& place = course.places[i];
    left.asked += 1.0;
    if (!place.seen) continue;
    left.answered += 1.0;
    left.joints.push_back(place.joints);
    left.stated.push_back(std::sqrt(place.covariance.trace()));
    if (place.off.dot(place.covariance.inverse() * place.off) <= kInside95) left.inside += 1.0;
  }
}

void add_course(Left& left, const Course& course, const std::vector<Window>& windows, double rate) {
  left.ids += static_cast<double>(course.ids.size());
  for (std::size_t i = 1; i < course.places.size(); ++i) {
    const Placed& now = course.places[i];
    const Placed& before = course.places[i - 1];
    if (now.seen && before.seen && (now.off - before.off).norm() > kLeap) left.leaps += 1.0;
    const double at = static_cast<double>(i) / rate;
    const bool alone = std::ranges::any_of(windows, [&](const Window& each) {
      return at >= each.begin && at < each.end + kSettledAfter;
    });
    if (now.seen && !alone) left.outside.push_back(now.joints);
  }
  for (const Window& each : windows) add_window(left, course, each, rate);
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? kNoRatio : sum / static_cast<double>(values.size());
}

void add_left_rows(Report& report, const std::string& name, const Left& left, const Left& all) {
  const auto millimetres = [&](const char* metric, double value) {
    report.row(name, metric, to_mm(value), "mm");
  };
  millimetres("place_half_median_mm", median(left.half));
  millimetres("place_end_median_mm", median(left.end));
  millimetres("place_end_p90_mm", percentile(left.end, 0.9));
  millimetres("place_end_worst_mm", worst(left.end));
  millimetres("stated_median_mm", median(left.stated));
  millimetres("growth_median_mm_s", median(left.growth));
  millimetres("growth_p90_mm_s", percentile(left.growth, 0.9));
  millimetres("joints_median_mm", median(left.joints));
  report.row(name, "inside_95_percent", 100.0 * left.inside / std::max(1.0, left.answered), "%");
  report.row(name, "missing_percent", 100.0 * (1.0 - left.answered / std::max(1.0, left.asked)),
             "%");
  report.row(name, "leaps", left.leaps, "1");
  report.row(name, "ids", left.ids, "1");
  millimetres("outside_mean_mm", mean_of(left.outside));
  millimetres("all_cameras_mean_mm", mean_of(all.outside));
  report.row(name, "all_cameras_leaps", all.leaps, "1");
  report.condition(name + ": the error of the place grows by 0.25 m/s at most (p90)",
                   percentile(left.growth, 0.9) <= 0.25);
  report.condition(name + ": the stated 95 % region holds the place in 90 %",
                   left.inside >= 0.9 * left.answered && left.answered > 0);
  report.condition(name + ": no leap over 0.3 m", left.leaps == 0.0);
}

}  // namespace

Result<void> measure_left(Report& report, const LeftTake& take, const Withholding& when) {
  Left left;
  Left all;
  const auto whole = course_of(take, take.tracks);
  if (!whole) return pass(whole);
  add_course(all, *whole, {}, take.rate_hz);
  const std::size_t turns = report.quick() || when.only ? 1 : take.tracks.size();
  for (std::size_t turn = 0; turn < turns; ++turn) {
    const auto windows = windows_of(take, when, turn);
    const auto course = course_of(take, withheld(take, windows));
    if (!course) return pass(course);
    add_course(left, *course, windows, take.rate_hz);
  }
  add_left_rows(report, take.name, left, all);
  return {};
}

}  // namespace chorus::bench
