// Cameras that send rays alone, registered from one person who walks and one measured distance:
// what the places err by, and how many of them would be used without asking anybody.
#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <random>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/error_radius.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/scene.h"
#include "fusion-server/registration/registration.h"
#include "tests/bench/camera/camera_cases.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using registration::WalkTrack;
using Truth = std::map<SensorId, Eigen::Isometry3d>;

constexpr double kAskedPlace = 60.0;  // [mm] median
constexpr double kAskedAngle = 0.5;   // [deg] median
constexpr double kWrong = 100.0;      // [mm]
constexpr std::size_t kOfEight = 4;   // cameras of a rig

/// One rig, its walk, and where the cameras truly stand.
struct RayWalk {
  std::vector<WalkTrack> tracks;
  Truth world_from_sensor;
};

/// Errors of the cameras of many rigs, our world laid on the true one by the master.
struct RayScores {
  std::vector<double> places;    ///< [mm]
  std::vector<double> shapes;    ///< After the factor that fits all cameras best [mm].
  std::vector<double> angles;    ///< [deg]
  std::vector<double> radii;     ///< Stated, on the floor, 95 % [mm].
  std::vector<double> on_floor;  ///< What they should hold [mm].
  double asked = 0.0;
  double good = 0.0;
  double unasked = 0.0;        ///< Used without asking somebody.
  double unasked_wrong = 0.0;  ///< Of these, off by more than kWrong.

  void add(const Registration& found, const RayWalk& walk);
  void report(Report& report, const std::string& name) const;
};

void RayScores::add(const Registration& found, const RayWalk& walk) {
  asked += static_cast<double>(walk.tracks.size()) - 1.0;
  good += found.verdict == Verdict::Good ? 1.0 : 0.0;
  if (!found.sensors.contains(found.master)) return;
  const Eigen::Isometry3d true_from_ours =
      walk.world_from_sensor.at(found.master) *
      found.sensors.at(found.master).world_from_sensor.inverse();
  const Eigen::Vector3d origin = walk.world_from_sensor.at(found.master).translation();
  double ours_ours = 0.0;
  double ours_true = 0.0;
  for (const auto& [sensor, place] : found.sensors) {
    const Eigen::Vector3d ours = true_from_ours * place.world_from_sensor.translation() - origin;
    ours_ours += ours.squaredNorm();
    ours_true += ours.dot(walk.world_from_sensor.at(sensor).translation() - origin);
  }
  for (const auto& [sensor, place] : found.sensors) {
    if (sensor == found.master) continue;
    const Eigen::Isometry3d ours = true_from_ours * place.world_from_sensor;
    const Eigen::Isometry3d& exact = walk.world_from_sensor.at(sensor);
    const Eigen::Vector3d off = ours.translation() - exact.translation();
    places.push_back(to_mm(off.norm()));
    const bool used = !found.verdicts.at(sensor).unconfirmed;
    unasked += used ? 1.0 : 0.0;
    unasked_wrong += used && places.back() > kWrong ? 1.0 : 0.0;
    shapes.push_back(to_mm(
        ((ours.translation() - origin) * (ours_true / ours_ours) - (exact.translation() - origin))
            .norm()));
    angles.push_back(to_deg(
        angular_distance(Eigen::Quaterniond(ours.linear()), Eigen::Quaterniond(exact.linear()))));
    radii.push_back(to_mm(radius_on_floor(place.covariance)));
    on_floor.push_back(to_mm(std::hypot(off.x(), off.z())));
  }
}

double share(double part, double whole) { return whole > 0.0 ? 100.0 * part / whole : kNoRatio; }

void RayScores::report(Report& report, const std::string& name) const {
  const auto count = static_cast<double>(places.size());
  double held = 0.0;
  for (std::size_t i = 0; i < radii.size(); ++i) held += on_floor[i] <= radii[i] ? 1.0 : 0.0;
  const auto wrong = std::ranges::count_if(places, [](double place) { return place > kWrong; });
  const double rigs = asked / static_cast<double>(kOfEight - 1);
  report.row(name, "place_mm", median(places), "mm");
  report.row(name, "place_p95_mm", percentile(places, 0.95), "mm");
  report.row(name, "place_worst_mm", worst(places), "mm");
  report.row(name, "shape_mm", median(shapes), "mm");
  report.row(name, "angle_deg", median(angles), "deg");
  report.row(name, "angle_p95_deg", percentile(angles, 0.95), "deg");
  report.row(name, "radius_mm", median(radii), "mm");
  report.row(name, "held_by_radius_percent", share(held, count), "%");
  report.row(name, "radius_over_median_error", median(radii) / median(on_floor), "");
  report.row(name, "refused_percent", share(asked - count, asked), "%");
  report.row(name, "over_100mm_percent", share(static_cast<double>(wrong), count), "%");
  report.row(name, "good_percent", share(good, rigs), "%");
  report.row(name, "used_unasked_percent", share(unasked, count), "%");
  report.row(name, "used_unasked_over_100mm", unasked_wrong, "");
  report.condition(fmt::format("{}: cameras within {:.0f} mm and {:.1f} deg in the median", name,
                               kAskedPlace, kAskedAngle),
                   median(places) <= kAskedPlace && median(angles) <= kAskedAngle);
}

/// The two cameras that stand farthest apart, and how far.
registration::KnownDistance longest(const RayWalk& walk) {
  registration::KnownDistance best;
  for (const auto& [a, first] : walk.world_from_sensor) {
    for (const auto& [b, second] : walk.world_from_sensor) {
      const double length = (first.translation() - second.translation()).norm();
      if (a < b && length > best.length) best = {a, b, length};
    }
  }
  return best;
}

Registration registered(const RayWalk& walk) {
  registration::RegistrationConfig config;
  config.known_distances = {longest(walk)};
  return registration::solve(walk.tracks, importers::kDefaultStart, config);
}

void score(Report& report, const std::string& name, const std::vector<RayWalk>& walks) {
  RayScores scores;
  for (const RayWalk& walk : walks) scores.add(registered(walk), walk);
  scores.report(report, name);
}

// -- simulated ----------------------------------------------------------------------------------

/// Landmarks of webcams of 65 degrees: 6 px from picture to picture, 6 px that last half a second.
constexpr double kWebcamFocal = 1005.0;  // [px]
constexpr double kWhite = 6.0 / kWebcamFocal;
constexpr double kSlow = 6.0 / kWebcamFocal;
constexpr double kLasts = 0.5;  // [s]

RayWalk simulated_walk(std::uint64_t seed) {
  synthetic::Ring ring;
  ring.count = kOfEight;
  ring.radius = 4.0;
  ring.height = 2.2;
  RayWalk walk;
  const synthetic::WalkerScript script{.seed = seed, .reach = 1.5};
  const synthetic::Scene scene{Timestamp{}, synthetic::make_people(script, 1), {}, {}};
  for (std::size_t i = 0; i < ring.count; ++i) {
    const SensorId id = SensorId::parse(fmt::format("cam{}", i)).value();
    const Eigen::Isometry3d place = synthetic::ring_place(ring, i);
    walk.world_from_sensor[id] = place;
    std::mt19937_64 random(seed * kOfEight + i);
    std::normal_distribution<double> normal;
    std::array<Eigen::Vector3d, kJointCount> slow{};
    const double keeps = std::exp(-1.0 / 30.0 / kLasts);
    WalkTrack track{id, {}};
    for (int k = 0; k < 900; ++k) {
      SensorFrame frame;
      frame.sensor = id;
      frame.captured = importers::kDefaultStart + k * Duration(33'333'333);
      Skeleton<SensorSpace> body =
          to_sensor(place.inverse(), synthetic::truth(scene, 0, frame.captured));
      for (std::size_t j = 0; j < kJointCount; ++j) {
        Joint& joint = body.joints[j];
        joint.orientation.coeffs().setZero();
        joint.measurement = Measurement::Ray;
        joint.position.normalize();
        for (int axis = 0; axis < 3; ++axis) {
          slow[j][axis] = keeps * slow[j][axis] + std::sqrt(1.0 - keeps * keeps) * normal(random);
          joint.position[axis] += kWhite * normal(random) + kSlow * slow[j][axis];
        }
        joint.position.normalize();
      }
      frame.bodies = {{BodyId{1}, frame.captured, body}};
      track.frames.push_back(std::move(frame));
    }
    walk.tracks.push_back(std::move(track));
  }
  return walk;
}

// -- eight real cameras -------------------------------------------------------------------------

/// Rigs of four of the cameras: of all sets every twelfth.
Result<std::vector<RayWalk>> rigs_of(const std::filesystem::path& take) {
  constexpr unsigned kEvery = 12;
  importers::ImportOptions options;
  options.rays = true;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {take}, options);
  if (!set) return pass(set);
  std::vector<RayWalk> rigs;
  unsigned number = 0;
  for (unsigned mask = 0; mask < 1U << set->recordings.size(); ++mask) {
    if (std::popcount(mask) != static_cast<int>(kOfEight) || number++ % kEvery != 0) continue;
    RayWalk walk;
    for (std::size_t i = 0; i < set->recordings.size(); ++i) {
      if ((mask >> i & 1U) == 0) continue;
      const auto& recording = set->recordings[i];
      walk.tracks.push_back({recording.sensor, recording.frames});
      walk.world_from_sensor[recording.sensor] = set->world_from_sensor.at(recording.sensor);
    }
    rigs.push_back(std::move(walk));
  }
  return rigs;
}

}  // namespace

Result<void> rays_alone(Report& report) {
  const std::uint64_t draws = report.quick() ? 1 : 10;
  std::vector<RayWalk> walks;
  for (std::uint64_t draw = 0; draw < draws; ++draw)
    walks.push_back(simulated_walk(report.seed() + draw));
  score(report, "rays-alone-simulated", walks);
  if (report.quick()) return {};
  const std::vector<std::filesystem::path> takes = eight_view_takes();
  for (const auto& take : takes) {
    const auto rigs = rigs_of(take);
    if (!rigs) return pass(rigs);
    score(report, fmt::format("rays-alone-{}", take.filename().string()), *rigs);
  }
  return {};
}

}  // namespace chorus::bench
