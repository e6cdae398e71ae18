// The takes of the case one-left: real ones, and a simulated walk.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <random>

#include <fmt/format.h>

#include "common/synthetic/scene.h"
#include "tests/bench/camera/camera_cases.h"
#include "tests/bench/camera/one_left.h"
#include "tests/judge/crowd.h"

namespace chorus::bench {
namespace {

constexpr double kFocalLength = 1005.0;  // [px] a webcam of 1280 x 720, 65 degrees across
constexpr double kPixels = 8.0;          // standard deviation of a landmark
constexpr double kGuessed = 0.12;        // stated error of a guessed depth, of the distance
constexpr double kSizeOff = 0.06;        // how far a camera has a person's size wrong, for good
constexpr double kWander = 0.04;         // and how far it wanders, within
constexpr double kWanderTime = 1.0;      // [s]
constexpr std::size_t kSimulated = 4;    // cameras
constexpr double kDepthNoise = 0.015;    // [m] per axis of a depth sensor's joint, white
constexpr double kDepthSlow = 0.020;     // and one that lasts for kDepthTime
constexpr double kDepthTime = 0.7;       // [s]

enum class Shows { Rays, Guesses, Depth };

/// Of one camera: how wrong it has the person's size.
struct SizeError {
  double always = 0.0;
  double now = 0.0;
};

/// What a camera makes of a joint.
class LeftCamera {
 public:
  LeftCamera(const Eigen::Isometry3d& world_from_camera, std::uint64_t seed)
      : camera_from_world_(world_from_camera.inverse()), random_(seed) {
    size_.always = kSizeOff * normal_(random_);
    size_.now = kWander * normal_(random_);
  }

  SensorFrame see(const Skeleton<WorldSpace>& person, Timestamp at, Shows what, double passed) {
    const double kept = std::exp(-passed / kWanderTime);
    const double slow = std::exp(-passed / kDepthTime);
    size_.now = kept * size_.now + std::sqrt(1.0 - kept * kept) * kWander * normal_(random_);
    SensorFrame frame;
    frame.captured = frame.received = at;
    BodyFrame body;
    body.id = BodyId{1};
    body.captured = at;
    body.skeleton = to_sensor(camera_from_world_, person);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (what != Shows::Depth) {
        show(body.skeleton.joints[j], what == Shows::Guesses);
        continue;
      }
      for (double& axis : slow_[j])
        axis = slow * axis + std::sqrt(1.0 - slow * slow) * normal_(random_);
      measure(body.skeleton.joints[j], slow_[j]);
    }
    frame.bodies.push_back(std::move(body));
    return frame;
  }

 private:
  /// As a depth sensor.
  void measure(Joint& joint, const std::array<double, 3>& slow) {
    joint.orientation.coeffs().setZero();
    joint.state = JointState::Tracked;
    for (int axis = 0; axis < 3; ++axis)
      joint.position[axis] +=
          kDepthNoise * normal_(random_) + kDepthSlow * slow[static_cast<std::size_t>(axis)];
  }

  void show(Joint& joint, bool points) {
    const Eigen::Vector3d exact = joint.position;
    joint = {};
    if (exact.z() < 0.2) return;
    const double pixel = kPixels / kFocalLength;
    const Eigen::Vector3d ray =
        Eigen::Vector3d(exact.x() / exact.z() + pixel * normal_(random_),
                        exact.y() / exact.z() + pixel * normal_(random_), 1.0)
            .normalized();
    joint.state = JointState::Tracked;
    joint.orientation.coeffs().setZero();
    joint.measurement = points ? Measurement::Point : Measurement::Ray;
    joint.position = ray;
    if (!points) return;
    const double depth = exact.norm() * (1.0 + size_.always + size_.now);
    const double across = pixel * depth;
    const double along = kGuessed * depth;
    joint.position *= depth;
    joint.covariance =
        Covariance(Eigen::Matrix3d(across * across * Eigen::Matrix3d::Identity() +
                                   (along * along - across * across) * ray * ray.transpose()));
  }

  Eigen::Isometry3d camera_from_world_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  SizeError size_;
  std::array<std::array<double, 3>, kJointCount> slow_{};  ///< Of a depth sensor, over kDepthSlow.
};

/// A folder of camera landmarks with published places and truth.
Result<LeftTake> real_take(const std::filesystem::path& folder, bool points, std::size_t step) {
  importers::ImportOptions options;
  options.rays = !points;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {folder}, options);
  if (!set) return pass(set);
  LeftTake take;
  take.places = published_places(*set);
  for (std::size_t i = 0; i < set->recordings.size(); i += step)
    take.tracks.push_back({set->recordings[i].sensor, set->recordings[i].frames});
  std::size_t length = set->truth.size();
  for (const auto& track : take.tracks) length = std::min(length, track.frames.size());
  for (std::size_t i = 0; i < length; ++i) take.truth.push_back(set->truth[i].skeleton);
  return take;
}

Result<void> add_real(Report& report, const std::filesystem::path& folder, std::size_t step) {
  for (const bool points : {false, true}) {
    auto take = real_take(folder, points, step);
    if (!take) return pass(take);
    const bool short_take = take->truth.size() < 200;
    const char* kind = points ? "points" : "rays";
    take->name = fmt::format("one-left-{}-{}", folder.filename().string(), kind);
    if (short_take) take->rate_hz = kTruthHz;
    const Withholding when = short_take ? Withholding{0.5, 10.0, 1.0} : Withholding{};
    if (const auto done = measure_left(report, *take, when); !done) return done;
  }
  return {};
}

}  // namespace

LeftTake simulated_take(std::uint64_t seed, bool points, bool among_depth) {
  constexpr double kLength = 34.0;  // [s]
  LeftTake take;
  take.name = fmt::format("one-left-{}-{}", among_depth ? "of-depth" : "simulated",
                          points ? "points" : "rays");
  synthetic::Ring ring;
  ring.count = kSimulated;
  ring.radius = 4.0;
  ring.height = 2.0;
  const synthetic::Scene scene{importers::kDefaultStart, people_around(1.2, seed), {}, {}};
  std::vector<LeftCamera> cameras;
  take.places.version = 1;
  take.places.verdict = Verdict::Good;
  for (std::size_t i = 0; i < kSimulated; ++i) {
    const auto id = SensorId::parse(fmt::format("cam{}", i)).value();
    if (i == 0) take.places.master = id;
    take.places.sensors[id].world_from_sensor = synthetic::ring_place(ring, i);
    cameras.emplace_back(synthetic::ring_place(ring, i), seed * kSimulated + i);
    take.tracks.push_back({id, {}});
  }
  for (int i = 0; i < static_cast<int>(kLength * take.rate_hz); ++i) {
    const Timestamp at = importers::kDefaultStart + from_seconds(i / take.rate_hz);
    take.truth.push_back(synthetic::truth(scene, 0, at));
    for (std::size_t c = 0; c < kSimulated; ++c) {
      const bool depth = among_depth && c + 1 < kSimulated;
      const Shows what = depth ? Shows::Depth : points ? Shows::Guesses : Shows::Rays;
      take.tracks[c].frames.push_back(
          cameras[c].see(take.truth.back(), at, what, 1.0 / take.rate_hz));
      take.tracks[c].frames.back().sensor = take.tracks[c].sensor;
      take.tracks[c].frames.back().sequence = static_cast<std::uint64_t>(i);
    }
  }
  return take;
}

Result<void> one_left(Report& report) {
  for (const bool points : {false, true}) {
    const auto take = simulated_take(report.seed(), points);
    if (const auto done = measure_left(report, take, {}); !done) return done;
    const auto mixed = simulated_take(report.seed(), points, true);
    Withholding last;
    last.only = kSimulated - 1;
    if (const auto done = measure_left(report, mixed, last); !done) return done;
  }
  if (const auto done = add_real(report, kFourViews, 1); !done) return done;
  for (const auto& path : eight_view_takes()) {
    if (const auto done = add_real(report, path, 2); !done) return done;  // every other camera
  }
  report.note(
      "one-left: four cameras, all but one lose the person for 2 s again and again (Pose2Sim's "
      "take of 1.7 s: once, 1 s); every camera in turn is left.  Place: the middle of shoulders "
      "and hips.  of-depth: three depth sensors and one camera, which is left each time.  growth: "
      "(error at the end - error before) / length.  simulated: simulator.");
  return {};
}

}  // namespace chorus::bench
