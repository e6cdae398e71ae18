#include "tests/bench/inertial/worn_takes.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <random>

#include "common/evaluation/calibrate.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/methods.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/inertial/real_takes.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using inertial::Limb;

fs::path eight_views_folder() {
  const char* stated = std::getenv("CHORUS_EIGHT_VIEWS");
  return stated != nullptr ? stated : "../shared/data/totalcapture_views";
}

/// The error of each real sensor in limb axes after its best calibration, at kSensorHz.
std::vector<std::vector<Eigen::Quaterniond>> real_errors(const RealTake& real) {
  std::vector<std::vector<Eigen::Quaterniond>> all;
  for (const RealSensor& sensor : real.sensors) {
    auto& errors = all.emplace_back();
    const auto pairs = pairs_of(sensor);
    const auto fit = evaluation::fit_calibration(pairs);
    if (!fit) continue;
    for (const auto& pair : pairs)
      errors.push_back(pair.tracked.world_from_limb.conjugate() *
                       inertial::predicted_limb(fit->calibration, pair.inertial_from_sensor));
  }
  return all;
}

/// The sequence there and back again, so that it has no leap.
const Eigen::Quaterniond& to_and_fro(const std::vector<Eigen::Quaterniond>& all, std::size_t i) {
  const std::size_t around = 2 * all.size() - 2;
  const std::size_t at = i % around;
  return all[at < all.size() ? at : around - at];
}

Result<WornTake> read_worn_take(const fs::path& path, const RealTake& real) {
  WornTake take;
  take.name = path.filename().string();
  importers::ImportOptions options;
  options.rays = true;
  auto set = importers::import_files(importers::FileFormat::Pose2Sim, {path}, options);
  if (!set) return pass(set);
  take.rays = std::move(*set);
  for (const auto& recording : take.rays.recordings)
    take.rays.truth.resize(std::min(take.rays.truth.size(), recording.frames.size()));
  const auto turned = orientation_rows(path / "gt_skel_gbl_ori.txt");
  if (!turned) return pass(turned);
  const auto errors = real_errors(real);
  for (std::size_t s = 0; s < real.sensors.size(); ++s) {
    StandIn sensor{real.sensors[s].limb, {}};
    for (std::size_t i = 0; i < turned->size() && !errors[s].empty(); ++i)
      sensor.world_from_limb.push_back(
          (under_sensor(sensor.limb, (*turned)[i]) * to_and_fro(errors[s], i)).normalized());
    take.sensors.push_back(std::move(sensor));
  }
  return take;
}

struct MountAndHeading {
  Eigen::Quaterniond mount;
  double heading;
};

MountAndHeading drawn_mount(std::uint64_t seed, std::size_t sensor) {
  std::mt19937_64 random(1000 * seed + sensor);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> any(-3.14159, 3.14159);
  const Eigen::Quaterniond mount(normal(random), normal(random), normal(random), normal(random));
  return {mount.normalized(), any(random)};
}

pipeline::FrameLane lane_of(const registration::WalkTrack& track) {
  auto next = std::make_shared<std::size_t>(0);
  return {track.sensor.str(), [track, next]() -> Result<std::optional<SensorFrame>> {
            if (*next >= track.frames.size()) return std::nullopt;
            return track.frames[(*next)++];
          }};
}

Registration places_of_some(const importers::ImportedSet& set,
                            const std::vector<std::size_t>& cameras) {
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  registration.master = set.recordings[cameras.front()].sensor;
  for (const std::size_t c : cameras) {
    const SensorId& sensor = set.recordings[c].sensor;
    registration.sensors[sensor].world_from_sensor = set.world_from_sensor.at(sensor);
  }
  return registration;
}

/// Of this process: a busy machine does not count.
double now_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

Result<std::vector<WornTake>> worn_takes() {
  std::vector<WornTake> out;
  const auto real = real_takes();
  if (!real) return pass(real);
  const auto thirteen = std::ranges::find(*real, "xsens13", &RealTake::name);
  for (const char* name : {"S1-freestyle2", "S2-freestyle1"}) {
    const fs::path path = eight_views_folder() / name;
    if (thirteen == real->end() || !fs::exists(path / "gt_skel_gbl_ori.txt")) continue;
    auto take = read_worn_take(path, *thirteen);
    if (!take) return pass(take);
    out.push_back(std::move(*take));
  }
  return out;
}

double true_heading(const SensorFaults& faults, std::size_t sensor, double time) {
  return wrap_angle(drawn_mount(faults.seed, sensor).heading + faults.drift * time);
}

inertial::InertialFrame said(const WornTake& take, const SensorFaults& faults, std::size_t index) {
  const double time = static_cast<double>(index) / kSensorHz;
  inertial::InertialFrame frame{
      *SensorId::parse(kStandInSuit), index, importers::kDefaultStart + from_seconds(time), {}, {}};
  for (std::size_t s = 0; s < take.sensors.size(); ++s) {
    const StandIn& sensor = take.sensors[s];
    if (index >= sensor.world_from_limb.size()) continue;
    Eigen::Quaterniond mount = drawn_mount(faults.seed, s).mount;
    if (faults.slips == sensor.limb && time >= faults.slips_at) {
      const Eigen::Vector3d axis = mount * Eigen::Vector3d(0.6, 0.0, 0.8);
      mount = exp_map(faults.slip * axis) * mount;
    }
    inertial::InertialReading reading;
    reading.sensor = std::string(name_of(sensor.limb));
    reading.captured = frame.captured;
    reading.magnetic = inertial::MagneticState::None;
    reading.inertial_from_sensor =
        about_y(-true_heading(faults, s, time)) * sensor.world_from_limb[index] * mount;
    frame.readings.push_back(std::move(reading));
  }
  return frame;
}

Result<std::vector<SeenInstant>> seen_by(const WornTake& take,
                                         const std::vector<std::size_t>& cameras,
                                         const Hides& hides) {
  pipeline::OfflineInput input;
  for (const std::size_t c : cameras) {
    registration::WalkTrack track{take.rays.recordings[c].sensor, take.rays.recordings[c].frames};
    for (std::size_t i = 0; hides && i < track.frames.size(); ++i)
      for (BodyFrame& body : track.frames[i].bodies)
        for (std::size_t j = 0; j < kJointCount; ++j)
          if (hides(static_cast<JointId>(j), i)) body.skeleton.joints[j] = {};
    input.lanes.push_back(lane_of(track));
    input.sensors.push_back(track.sensor);
  }
  pipeline::OfflineConfig config;
  config.rate_hz = kTakeHz;
  std::vector<SeenInstant> seen(take.size());
  const auto visit = [&](const Snapshot& snapshot, const std::vector<Person>& people) {
    const double at = seconds(snapshot.instant - importers::kDefaultStart) * kTakeHz;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    if (index < seen.size()) seen[index] = {snapshot.instant, snapshot.sensors, people};
    return Result<void>{};
  };
  const auto done = pipeline::visit_recordings(std::move(input), places_of_some(take.rays, cameras),
                                               config, visit);
  if (!done) return pass(done);
  return seen;
}

FusedTake fused_with(const WornTake& take, const std::vector<SeenInstant>& seen,
                     const SensorFaults* faults, const AfterInstant& each) {
  FusedTake out;
  out.bodies.resize(seen.size());
  fusion::FusionConfig config;
  config.inertial.enabled = faults != nullptr;
  worn::WornConfig worn;
  worn.enabled = faults != nullptr;
  out.wear.configure(worn, {*SensorId::parse(kStandInSuit)});
  fusion::Memory memory;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (seen[i].people.empty()) continue;
    std::vector<Person> people = seen[i].people;
    std::vector<inertial::InertialFrame> frames;
    for (std::size_t k = 2 * i; faults != nullptr && k < 2 * i + 2; ++k)
      frames.push_back(said(take, *faults, k));
    const double begin = now_seconds();
    for (inertial::InertialFrame& frame : frames) out.wear.take(std::move(frame));
    if (faults != nullptr) dress(people, out.wear.say(seen[i].at));
    const double dressed = now_seconds();
    const auto bodies = memory.fuse(people, {seen[i].at, seen[i].sensors}, config);
    const double fused = now_seconds();
    if (faults != nullptr) out.wear.learn(bodies, seen[i].at);
    out.seconds_fusing += fused - dressed;
    out.seconds_wearing += dressed - begin + now_seconds() - fused;
    if (!bodies.empty()) out.bodies[i] = bodies.front();
    if (each) each(i, out.wear);
  }
  return out;
}

FusedTake fused_by_body_filter(const std::vector<SeenInstant>& seen) {
  FusedTake out;
  out.bodies.resize(seen.size());
  const auto filter = fusion::begin(fusion::Method::BodyFilter, {});
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i].people.empty())
      out.bodies[i] = filter->fuse(seen[i].people.front(), {seen[i].at, seen[i].sensors});
  }
  return out;
}

}  // namespace chorus::bench
