// The rendered rows of `chorus-bench positioner`: every method on the same frames.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <tuple>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/importers/import_options.h"
#include "common/positioning/paper_smoothing.h"
#include "common/synthetic/walker.h"
#include "tests/bench/positioner/position_errors.h"
#include "tests/bench/positioner/positioner_cases.h"
#include "tests/bench/positioner/rendered_scenes.h"

namespace chorus::bench {
namespace {

using positioning::Method;
using positioning::Placed;
using positioning::TakeResult;

const Eigen::Isometry3d kFront = looking({0, 2.0, 4.6}, {0, 0.9, 0});
const Eigen::Isometry3d kSide = looking({4.4, 1.8, 0.6}, {0, 0.9, 0});

std::function<Skeleton<WorldSpace>(double)> walking(std::uint64_t seed) {
  auto walker = std::make_shared<const synthetic::Walker>(
      synthetic::WalkerScript{.seed = seed, .reach = 1.4});
  return [walker](double time) { return walker->at(from_seconds(time + 10.0)); };
}

/// The same body, moved.
std::function<Skeleton<WorldSpace>(double)> carried(
    std::function<Skeleton<WorldSpace>(double)> body, std::function<Eigen::Vector3d(double)> by) {
  return [body = std::move(body), by = std::move(by)](double time) {
    Skeleton<WorldSpace> out = body(time);
    const Eigen::Vector3d shift = by(time);
    for (Joint& joint : out.joints) joint.position += shift;
    return out;
  };
}

/// Standing, then knees bent and straight again every three seconds; the feet stay.
Skeleton<WorldSpace> crouched(Skeleton<WorldSpace> body, double depth) {
  using enum JointId;
  for (const auto& [hip, knee, ankle] :
       {std::array{HipLeft, KneeLeft, AnkleLeft}, std::array{HipRight, KneeRight, AnkleRight}}) {
    const Eigen::Vector3d a = body[hip].position - Eigen::Vector3d(0, depth, 0);
    const Eigen::Vector3d c = body[ankle].position;
    const double upper = (body[knee].position - body[hip].position).norm();
    const double lower = (body[ankle].position - body[knee].position).norm();
    const Eigen::Vector3d line = c - a;
    const double length = std::min(line.norm(), upper + lower - 1e-4);
    const double along = (upper * upper - lower * lower + length * length) / (2.0 * length);
    const double out = std::sqrt(std::max(0.0, upper * upper - along * along));
    const Eigen::Vector3d left = body[HipLeft].position - body[HipRight].position;
    const Eigen::Vector3d ahead = left.cross(Eigen::Vector3d::UnitY()).normalized();
    body[knee].position = a + along * line.normalized() + out * ahead;
  }
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto id = static_cast<JointId>(i);
    if (id == KneeLeft || id == KneeRight || id == AnkleLeft || id == AnkleRight ||
        id == FootLeft || id == FootRight)
      continue;
    body[id].position.y() -= depth;
  }
  return body;
}

struct MethodScore {
  PlaceScores online, smooth;
  double clock = 0.0, heading = 0.0, heading_sigma = 0.0, stature = 0.0, stature_sigma = 0.0;
  double jump = 0.0;  ///< Largest error of the height [m].
  double acceleration = 0.0;
  double kalman = 0.0;  ///< RMS after the paper's other filter [m].
};

/// The error of the online places after a constant-velocity filter (Madaras et al. 3.7).
double kalman_error(const TakeResult& result, const std::vector<Eigen::Vector3d>& roots) {
  std::vector<Eigen::Vector3d> places;
  for (const Placed& one : result.placed) places.push_back(one.online.position.place);
  const auto smooth = positioning::kalman_smoothed(places);
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < smooth.size(); ++i) {
    const auto at =
        static_cast<std::size_t>(std::lround(seconds(result.placed[i].time) * kSceneRate));
    if (at >= roots.size()) continue;
    sum += (smooth[i] - roots[at]).squaredNorm();
    count += 1.0;
  }
  return std::sqrt(sum / std::max(1.0, count));
}

std::vector<FoundPlace> places_of(const TakeResult& result, std::size_t count, bool smooth) {
  std::vector<FoundPlace> out(count);
  for (const Placed& one : result.placed) {
    const auto i = static_cast<std::size_t>(std::lround(seconds(one.time) * kSceneRate));
    if (i >= count) continue;
    const positioning::Position& at = smooth ? one.smooth : one.online.position;
    out[i] = {at.place, at.covariance};
  }
  return out;
}

std::vector<Eigen::Vector3d> roots_of(const RenderedScene& scene) {
  std::vector<Eigen::Vector3d> out;
  for (const auto& body : scene.truth) out.push_back(body[JointId::SpineBase].position);
  return out;
}

/// Root mean square of the second differences [m/s^2].
double acceleration_of(const std::vector<FoundPlace>& places) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 2; i < places.size(); ++i) {
    if (!places[i].place || !places[i - 1].place || !places[i - 2].place) continue;
    sum += (*places[i].place - 2.0 * *places[i - 1].place + *places[i - 2].place).squaredNorm();
    ++count;
  }
  return kSceneRate * kSceneRate *
         std::sqrt(sum / std::max<double>(1.0, static_cast<double>(count)));
}

/// `suit` and `silhouettes` are told the beginning, the heading and the clock, as the paper's user
/// tells them; the others find them.
Result<MethodScore> score_of(const RenderedScene& scene, Method method) {
  const std::vector<Eigen::Vector3d> roots = roots_of(scene);
  positioning::TakeSettings settings;
  settings.clocks.start = importers::kDefaultStart;
  settings.rate_hz = kSceneRate;
  settings.clocks.farthest_s = 0.3;
  settings.tracker.stature = kSceneStature;
  settings.tracker.method = method;
  if (!uses_landmarks(method)) {
    settings.clocks.offset_s = scene.script.clock;
    settings.tracker.heading = scene.script.suit.heading;
  }
  if (method == Method::Suit || method == Method::Silhouettes)
    settings.tracker.start = roots.front();
  const auto result = positioning::place_take(scene.cameras, scene.suit, settings);
  if (!result) return pass(result);
  const Eigen::Vector3d eye = scene.script.cameras.front().translation();
  MethodScore out;
  const auto online = places_of(*result, roots.size(), false);
  out.online = scores_of(online, roots, eye);
  out.smooth = scores_of(places_of(*result, roots.size(), true), roots, eye);
  out.clock = result->clocks.cameras.front().offset - scene.script.clock;
  out.heading = wrap_angle(result->heading - scene.script.suit.heading);
  out.heading_sigma = result->heading_sigma;
  out.acceleration = acceleration_of(online);
  out.kalman = kalman_error(*result, roots);
  if (!result->depth.empty()) std::tie(out.stature, out.stature_sigma) = result->depth.front();
  for (std::size_t i = 0; i < roots.size(); ++i)
    if (online[i].place)
      out.jump = std::max(out.jump, std::abs(online[i].place->y() - roots[i].y()));
  return out;
}

void add_method(Report& report, const std::string& scene, Method method, const MethodScore& score,
                double beside) {
  const std::string name = scene + "/" + std::string(positioning::name_of(method));
  report.row(name, "online_rms_mm", 1e3 * score.online.rms, "mm", beside > 0.0 ? "silhouettes" : "",
             beside > 0.0 ? score.online.rms / beside : kNoRatio);
  report.row(name, "online_p95_mm", 1e3 * score.online.p95, "mm");
  report.row(name, "smoothed_rms_mm", 1e3 * score.smooth.rms, "mm");
  report.row(name, "answered_percent", 100.0 * score.online.answered, "%");
  report.row(name, "nees_along", score.online.nees_along, "1");
  report.row(name, "nees_across", score.online.nees_across, "1");
  if (method == Method::Silhouettes) report.row(name, "kalman_rms_mm", 1e3 * score.kalman, "mm");
  if (method != Method::Both) return;
  report.row(name, "along_mm", 1e3 * score.online.rms_along, "mm");
  report.row(name, "across_mm", 1e3 * score.online.rms_across, "mm");
  report.row(name, "clock_error_ms", 1e3 * score.clock, "ms");
  report.row(name, "heading_error_deg", to_deg(score.heading), "deg");
  report.row(name, "heading_nees", std::pow(score.heading / score.heading_sigma, 2), "1");
  report.row(name, "depth_error_percent", 100.0 * score.stature, "%");
  report.row(name, "worst_height_mm", 1e3 * score.jump, "mm");
  report.row(name, "acceleration", score.acceleration, "m/s2");
}

constexpr std::array kCompared{Method::Silhouettes, Method::Suit, Method::Outline,
                               Method::Landmarks, Method::Both};

Result<void> run_scene(Report& report, SceneScript script,
                       std::span<const Method> methods = kCompared) {
  const RenderedScene scene = rendered_scene(std::move(script));
  double beside = 0.0;
  std::vector<FoundPlace> true_places;
  for (const Eigen::Vector3d& root : roots_of(scene)) true_places.push_back({.place = root});
  report.row(scene.script.name + "/truth", "acceleration", acceleration_of(true_places), "m/s2");
  for (const Method method : methods) {
    const auto score = score_of(scene, method);
    if (!score) {
      report.note(scene.script.name + "/" + std::string(positioning::name_of(method)) + ": " +
                  to_string(score.error()));
      continue;
    }
    add_method(report, scene.script.name, method, *score, beside);
    if (method == Method::Silhouettes) beside = score->online.rms;
  }
  return {};
}

SceneScript scene(const Report& report, std::string name) {
  SceneScript out;
  out.name = std::move(name);
  out.body = walking(report.seed() + 2);
  out.cameras = {kFront};
  out.seed = report.seed();
  if (report.quick()) out.length = 3.0;
  return out;
}

}  // namespace

Result<void> rendered_walk(Report& report) {
  if (auto done = run_scene(report, scene(report, "walk")); !done) return done;
  if (report.quick()) return {};
  SceneScript fine = scene(report, "walk-d2cm");
  fine.search.shift = 0.02;
  constexpr std::array kPaper{Method::Silhouettes};
  if (auto done = run_scene(report, std::move(fine), kPaper); !done) return done;
  SceneScript other = scene(report, "walk-pose-4deg");
  other.suit.bone = 2.0 * other.suit.bone;
  return run_scene(report, std::move(other));
}

Result<void> rendered_slide(Report& report) {
  // The person slides half a metre a second along a square while walking on the spot.
  SceneScript slides = scene(report, "slide");
  slides.body = carried(walking(report.seed() + 2), [](double time) {
    const double at = std::fmod(0.5 * time, 4.0);
    if (at < 1.0) return Eigen::Vector3d(at, 0, 0);
    if (at < 2.0) return Eigen::Vector3d(1, 0, -(at - 1.0));
    if (at < 3.0) return Eigen::Vector3d(1.0 - (at - 2.0), 0, -1);
    return Eigen::Vector3d(0, 0, -1.0 + (at - 3.0));
  });
  if (auto done = run_scene(report, std::move(slides)); !done) return done;
  // A leap every two seconds, 0.31 m high and 1 m along x and back; the legs stay as they are.
  SceneScript jumps = scene(report, "jump");
  jumps.body = carried(walking(report.seed() + 2), [](double time) {
    constexpr double kFlight = 0.5;  // [s]
    const double phase = std::fmod(time, 4.0);
    const double in = phase < 2.0 ? phase - 1.0 : phase - 3.0;
    const double share = std::clamp(in / kFlight, 0.0, 1.0);
    const double height = 0.5 * 9.81 * kFlight * kFlight * share * (1.0 - share);
    return Eigen::Vector3d(phase < 2.0 ? share : 1.0 - share, height, 0);
  });
  if (auto done = run_scene(report, std::move(jumps)); !done) return done;
  SceneScript crouches = scene(report, "crouch");
  crouches.body = [stand = walking(report.seed() + 2)](double time) {
    const double depth = 0.35 * std::pow(std::sin(2.0 * 3.14159265 * time / 6.0), 2);
    return crouched(stand(time), depth);
  };
  return run_scene(report, std::move(crouches));
}

Result<void> rendered_occlusion(Report& report) {
  SceneScript half = scene(report, "occlusion-half");
  half.cover = [](double) { return SceneCover{0.0, 0.58, 1.0, 1.0}; };
  if (auto done = run_scene(report, std::move(half)); !done) return done;
  SceneScript whole = scene(report, "occlusion-2s");
  whole.cover = [](double time) -> std::optional<SceneCover> {
    const double phase = std::fmod(time, 6.0);
    if (phase < 2.0 || phase > 4.0) return std::nullopt;
    return SceneCover{};
  };
  return run_scene(report, std::move(whole));
}

Result<void> rendered_light(Report& report) {
  SceneScript lamp = scene(report, "light-lamp");
  lamp.light = {.lamp = 35.0};
  SceneScript shadow = scene(report, "light-shadow");
  shadow.light = {.shadow = 0.35};
  SceneScript chair = scene(report, "light-chair");
  chair.light = {.chair_moved = true};
  SceneScript stranger = scene(report, "light-stranger");
  stranger.stranger = true;
  for (SceneScript* each : {&lamp, &shadow, &chair, &stranger})
    if (auto done = run_scene(report, std::move(*each)); !done) return done;
  return {};
}

Result<void> rendered_two_cameras(Report& report) {
  SceneScript one = scene(report, "two-cameras/front");
  SceneScript other = scene(report, "two-cameras/side");
  other.cameras = {kSide};
  SceneScript both = scene(report, "two-cameras/both");
  both.cameras = {kFront, kSide};
  SceneScript late = both;
  late.name = "two-cameras/late-100ms";
  late.late = 0.1;
  for (SceneScript* each : {&one, &other, &both, &late})
    if (auto done = run_scene(report, std::move(*each)); !done) return done;
  return {};
}

}  // namespace chorus::bench
