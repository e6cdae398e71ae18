// Four real cameras before one person (Pose2Sim's videos that ship with the tests), each alone and
// from its pixels; the suit is the person as the other three cameras show it, every bone erring.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "common/base/median.h"
#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/importers/formats.h"
#include "common/positioning/take.h"
#include "services/ctl/calibrate/lens_file.h"
#include "services/ctl/convert/video_sights.h"
#include "services/sensor/device/camera/film.h"
#include "tests/bench/camera/triangulation.h"
#include "tests/bench/positioner/position_errors.h"
#include "tests/bench/positioner/positioner_cases.h"
#include "tests/bench/positioner/suit_stand_in.h"

namespace chorus::bench {
namespace {

using positioning::Method;

constexpr double kVideoRate = 30.0;  // [Hz]
constexpr double kTruthRate = 60.0;  // Every second instant of the truth is a picture.
constexpr const char* kVideos = "tests/data/pose2sim_videos/four";
constexpr const char* kTruthFolder = "tests/data/pose2sim_mediapipe";
constexpr const char* kRunnerModules = "services/pose-runner/node_modules";

struct PixelCamera {
  positioning::CameraTake take;
  camera::CameraSettings settings;
  std::shared_ptr<ctl::PersonMasks> masks = std::make_shared<ctl::PersonMasks>();
};

Result<PixelCamera> looked_through(const SensorId& id, const Eigen::Isometry3d& place) {
  const std::string stem = std::string(kVideos) + "/" + id.str();
  auto settings = ctl::read_lens_file(stem + ".json");
  if (!settings) return pass(settings);
  PixelCamera out{{id, place, {}}, std::move(*settings)};
  out.settings.source = stem + ".mp4";
  out.settings.loop = false;
  out.settings.max_rate_hz = kVideoRate;
  camera::Film film{out.settings,
                    {"node", "services/pose-runner/runner.mjs", "--model", "blazepose-full"},
                    id,
                    importers::kDefaultStart};
  film.mask = [masks = out.masks](Timestamp captured, camera::PersonMask mask) {
    masks->emplace(captured, std::move(mask));
  };
  auto frames = camera::look_through(film);
  if (!frames) return pass(frames);
  out.take.frames = std::move(frames->frames);
  return out;
}

struct PixelMethod {
  const char* name;
  Method method;
  bool mask;
};
constexpr std::array kPixelMethods{PixelMethod{"silhouettes", Method::Silhouettes, false},
                                   PixelMethod{"silhouettes-mask", Method::Silhouettes, true},
                                   PixelMethod{"suit", Method::Suit, false},
                                   PixelMethod{"outline", Method::Outline, false},
                                   PixelMethod{"outline-mask", Method::Outline, true},
                                   PixelMethod{"landmarks", Method::Landmarks, false},
                                   PixelMethod{"both", Method::Both, true}};

struct PixelTruth {
  std::vector<Eigen::Vector3d> roots;
  suit::SuitTake suit;  ///< Without the camera that is judged.
  double stature = 1.75;
};

Result<PlaceScores> score(const PixelCamera& camera, const PixelTruth& truth,
                          const PixelMethod& method) {
  positioning::CameraTake take = camera.take;
  if (uses_pictures(method.method)) {
    ctl::VideoSights how{camera.settings, take.world_from_sensor,
                         silhouette::usual_shape(truth.stature)};
    if (method.mask) how.masks = camera.masks;
    for (const SensorFrame& frame : take.frames) how.times.push_back(frame.captured);
    auto sights = ctl::video_sights(std::move(how));
    if (!sights) return pass(sights);
    take.sight = std::move(*sights);
  }
  positioning::TakeSettings settings;
  settings.clocks.start = importers::kDefaultStart;
  settings.rate_hz = kVideoRate;
  settings.clocks.offset_s = 0.0;
  settings.tracker.stature = truth.stature;
  settings.tracker.method = method.method;
  if (!uses_landmarks(method.method)) settings.tracker.heading = 0.0;
  if (method.method == Method::Silhouettes || method.method == Method::Suit)
    settings.tracker.start = truth.roots.front();
  const auto result = positioning::place_take({&take, 1}, truth.suit, settings);
  if (!result) return pass(result);
  std::vector<FoundPlace> found(truth.roots.size());
  for (const positioning::Placed& one : result->placed) {
    const auto i = static_cast<std::size_t>(std::lround(seconds(one.time) * kVideoRate));
    if (i < found.size()) found[i] = {one.online.position.place, one.online.position.covariance};
  }
  return scores_of(found, truth.roots, take.world_from_sensor.translation());
}

using Bodies = std::vector<Skeleton<WorldSpace>>;

/// The joint of the reference that a ray passes nearest to, of the joint itself and its other side:
/// the network exchanges left and right, the reference does not.
JointId nearer_side(const SeenAlong& ray, JointId id, const Skeleton<WorldSpace>& reference) {
  const JointId other = mirror(id);
  const auto off = [&](JointId joint) {
    return ray.direction.cross(reference[joint].position - ray.eye).norm();
  };
  return off(other) < off(id) ? other : id;
}

/// The person as all cameras but one see it: robust triangulation of each instant.  A joint that
/// they cannot place is where the reference has it.
Bodies without(const SensorId& judged, const importers::ImportedSet& set, const Bodies& reference) {
  Bodies out = reference;
  for (std::size_t i = 0; i < out.size(); ++i) {
    std::array<std::vector<SeenAlong>, kJointCount> seen;
    for (const auto& recording : set.recordings) {
      if (recording.sensor == judged || recording.frames[i].bodies.empty()) continue;
      const Eigen::Isometry3d& place = set.world_from_sensor.at(recording.sensor);
      const auto& rays = recording.frames[i].bodies.front().skeleton;
      for (std::size_t k = 0; k < kJointCount; ++k) {
        const auto id = static_cast<JointId>(k);
        if (!rays[id].bears()) continue;
        const SeenAlong ray{place.translation(), (place.linear() * rays[id].position).normalized()};
        seen[static_cast<std::size_t>(nearer_side(ray, id, reference[i]))].push_back(ray);
      }
    }
    for (std::size_t k = 0; k < kJointCount; ++k) {
      if (const auto point = triangulated(seen[k])) out[i].joints[k].position = *point;
    }
  }
  return out;
}

/// As a suit holds a person: bones that do not change, and no jitter of single pictures, which
/// would look like jumps.
Bodies held(const Bodies& seen) {
  constexpr double kSmoothing = 2.0;  // Instants: 33 ms.
  constexpr std::ptrdiff_t kReach = 6;
  const auto count = static_cast<std::ptrdiff_t>(seen.size());
  Bodies smooth = seen;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    // As many instants before as after, or the ends would lag.
    const std::ptrdiff_t reach = std::min({kReach, i, count - 1 - i});
    for (std::size_t k = 0; k < kJointCount; ++k) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      double weights = 0.0;
      for (std::ptrdiff_t by = -reach; by <= reach; ++by) {
        const double off = static_cast<double>(by) / kSmoothing;
        const double weight = std::exp(-0.5 * off * off);
        sum += weight * seen[static_cast<std::size_t>(i + by)].joints[k].position;
        weights += weight;
      }
      smooth[static_cast<std::size_t>(i)].joints[k].position = sum / weights;
    }
  }
  Bodies out = smooth;
  for (const Bone& bone : kBones) {
    std::vector<double> lengths;
    for (const auto& body : smooth)
      lengths.push_back((body[bone.child].position - body[bone.parent].position).norm());
    const double usual = median(lengths);
    for (std::size_t i = 0; i < out.size(); ++i) {
      const Eigen::Vector3d way = smooth[i][bone.child].position - smooth[i][bone.parent].position;
      out[i][bone.child].position = out[i][bone.parent].position + usual * way.stableNormalized();
    }
  }
  return out;
}

void add_methods(Report& report, const PixelCamera& camera, const PixelTruth& truth) {
  double beside = kNoRatio;
  for (const PixelMethod& method : kPixelMethods) {
    const std::string name = "four-views/" + camera.take.sensor.str() + "/" + method.name;
    const auto scores = score(camera, truth, method);
    if (!scores) {
      report.note(name + ": " + to_string(scores.error()));
      continue;
    }
    if (beside != beside) beside = scores->rms;
    report.row(name, "online_rms_mm", 1e3 * scores->rms, "mm", "silhouettes", scores->rms / beside);
    report.row(name, "online_p95_mm", 1e3 * scores->p95, "mm");
    report.row(name, "answered_percent", 100.0 * scores->answered, "%");
    report.row(name, "nees_along", scores->nees_along, "1");
    report.row(name, "nees_across", scores->nees_across, "1");
  }
}

}  // namespace

Result<void> four_views_pixels(Report& report) {
  if (!std::filesystem::exists(kRunnerModules)) {
    report.note("four-views: left out; needs npm ci in services/pose-runner/");
    return {};
  }
  importers::ImportOptions options;
  options.rays = true;
  const auto set =
      importers::import_files(importers::FileFormat::Pose2Sim, {kTruthFolder}, options);
  if (!set) return pass(set);
  PixelTruth truth;
  Bodies bodies;
  for (std::size_t i = 0; i < set->truth.size(); ++i) {
    bodies.push_back(set->truth[i].skeleton);
    if (i % 2 == 0) truth.roots.push_back(bodies.back()[JointId::SpineBase].position);
  }
  for (const auto& [id, place] : set->world_from_sensor) {
    const auto camera = looked_through(id, place);
    if (!camera) return pass(camera);
    truth.suit = suit_of(held(without(id, *set, bodies)), kTruthRate, {});
    const double own = suit::stature_of(truth.suit.poses.front());
    if (own > 0.0) truth.stature = own;
    add_methods(report, *camera, truth);
  }
  return {};
}

}  // namespace chorus::bench
