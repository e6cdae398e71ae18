// chorus-bench real: fuses the bundled four camera views of a real person by all our methods, and
// compares them with the published triangulation (tests/data/README.md; accurate to a few cm).
//
// Every method runs twice: with the published extrinsics, and with extrinsics registered from the
// person alone.
#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/geometry/rigid_fit.h"
#include "common/importers/formats.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/report/report.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using fusion::Method;
using importers::CalibratedCamera;
using importers::ImportedSet;
using importers::Lateral;

constexpr const char* kFolder = "tests/data/pose2sim_mediapipe";  // run from the repository root
constexpr double kRateHz = 60.0;                                  // of the recording
// Errors measured outside this project: of the plain mean of the four cameras, and of the best
// camera.
constexpr double kPlainMeanMm = 104;
constexpr double kBestCameraMm = 140;

constexpr double kNoWorseMm = 5;

using Truth = std::vector<importers::TruthFrame>;

/// Fused joints paired with the true ones.
struct JointPairs {
  std::vector<Eigen::Vector3d> fused;
  std::vector<Eigen::Vector3d> truth;

  void add(const Skeleton<WorldSpace>& body, const Skeleton<WorldSpace>& true_body) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!body.joints[j].seen() || !true_body.joints[j].seen()) continue;
      fused.push_back(body.joints[j].position);
      truth.push_back(true_body.joints[j].position);
    }
  }
  [[nodiscard]] double percentile_mm(const Eigen::Isometry3d& truth_from_fused, double part) const {
    std::vector<double> errors;
    for (std::size_t i = 0; i < fused.size(); ++i)
      errors.push_back((truth_from_fused * fused[i] - truth[i]).norm());
    return to_mm(percentile(std::move(errors), part));
  }
};

double camera_error_mm(const record::FrameRecording& view, const Eigen::Isometry3d& pose,
                       const Truth& truth) {
  JointPairs pairs;
  for (std::size_t i = 0; i < view.frames.size(); ++i) {
    for (const BodyFrame& body : view.frames[i].bodies)
      pairs.add(to_world(pose, body.skeleton), truth[i].skeleton);
  }
  return pairs.percentile_mm(Eigen::Isometry3d::Identity(), 0.5);
}

/// The pose of our world in the published one, determined from the master alone.
Eigen::Isometry3d published_from_ours(const Registration& ours, const Registration& published) {
  return published.sensors.at(ours.master).world_from_sensor *
         ours.sensors.at(ours.master).world_from_sensor.inverse();
}

struct FusedScore {
  double median_mm = std::numeric_limits<double>::quiet_NaN();
  double p90_mm = std::numeric_limits<double>::quiet_NaN();
  /// Median error after the best rigid motion.
  double shape_mm = std::numeric_limits<double>::quiet_NaN();
  double bodies_per_frame = 0.0;
  std::size_t frames = 0;
  double missing_percent = 0.0;  ///< True joints that are not reported, in all frames.
};

/// The rigid motion that brings most joints onto the truth; those far off, such as swapped ones,
/// hardly count.
Eigen::Isometry3d best_motion(const JointPairs& pairs) {
  constexpr int kRounds = 20;
  constexpr double kScale = 0.05;  // [m]; at this distance the Cauchy weight is one half
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  std::vector<double> weights(pairs.fused.size(), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    const auto fit = fit_rigid(pairs.fused, pairs.truth, weights);
    if (!fit) return motion;
    motion = fit->target_from_source;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double off = (motion * pairs.fused[i] - pairs.truth[i]).norm() / kScale;
      weights[i] = 1.0 / (1.0 + off * off);
    }
  }
  return motion;
}

double joints_of(const Truth& truth) {
  double joints = 0.0;
  for (const importers::TruthFrame& frame : truth)
    joints += static_cast<double>(std::ranges::count_if(frame.skeleton.joints, &Joint::seen));
  return joints;
}

FusedScore score(const pipeline::OfflineResult& result, const Eigen::Isometry3d& truth_from_world,
                 const Truth& truth) {
  JointPairs pairs;
  FusedScore score;
  for (const Snapshot& snapshot : result.snapshots) {
    const double at = seconds(snapshot.instant - importers::kDefaultStart) * kRateHz;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    if (index >= truth.size() || snapshot.bodies.empty()) continue;
    ++score.frames;
    score.bodies_per_frame += static_cast<double>(snapshot.bodies.size());
    for (const FusedBody& body : snapshot.bodies) pairs.add(body.skeleton, truth[index].skeleton);
  }
  if (score.frames > 0) score.bodies_per_frame /= static_cast<double>(score.frames);
  score.median_mm = pairs.percentile_mm(truth_from_world, 0.5);
  score.p90_mm = pairs.percentile_mm(truth_from_world, 0.9);
  score.missing_percent =
      100.0 * (1.0 - static_cast<double>(pairs.fused.size()) / joints_of(truth));
  score.shape_mm = pairs.percentile_mm(best_motion(pairs), 0.5);
  return score;
}

struct Case {
  const char* name;
  Method method;
};

const Case kCases[] = {{"mean", Method::Mean},
                       {"otto", Method::Otto},
                       {"best-view", Method::BestView},
                       {"inverse-variance", Method::InverseVariance},
                       {"body-filter", Method::BodyFilter}};

pipeline::OfflineConfig config_for(const Case& each) {
  pipeline::OfflineConfig config;
  config.rate_hz = kRateHz;
  config.pipeline.fusion.method = each.method;
  // Views of one person differ by up to half a metre in depth; there is only one person.
  config.pipeline.association.gate = 1.5;
  config.pipeline.association.cluster = 1.5;
  // This setting is also in tests/data/pose2sim_mediapipe/fusion.json, which gives the reason.
  config.registration.joints = registration::JointChoice::All;
  config.registration.along_ratio = 8.0;
  config.registration.use_floor = false;
  config.registration.min_spread = 0.0;
  config.registration.max_edge_rms = 0.5;
  config.registration.max_speed = 10.0;
  config.registration.max_position = 1.5;
  return config;
}

std::vector<registration::WalkTrack> tracks_of(const std::vector<record::FrameRecording>& views) {
  std::vector<registration::WalkTrack> tracks;
  for (const auto& view : views) tracks.push_back({view.sensor, view.frames});
  return tracks;
}

Registration published_registration(const ImportedSet& set) {
  Registration registration;
  registration.verdict = Verdict::Good;
  registration.master = set.recordings.front().sensor;
  for (const auto& [sensor, pose] : set.world_from_sensor) {
    registration.sensors[sensor].world_from_sensor = pose;
    registration.sensors[sensor].chain = {sensor};
  }
  return registration;
}

/// The views of the method that the data's README describes: rigid perspective-n-point per camera.
Result<std::vector<record::FrameRecording>> plain_views() {
  const auto cameras = importers::read_cameras(std::string(kFolder) + "/cameras.json");
  if (!cameras) return pass(cameras);
  std::vector<record::FrameRecording> views;
  for (const CalibratedCamera& camera : *cameras) {
    auto view = importers::read_camera_view(fmt::format("{}/{}.json", kFolder, camera.sensor.str()),
                                            *cameras, {}, Lateral::RigidBody);
    if (!view) return pass(view);
    views.push_back(std::move(*view));
  }
  return views;
}

/// Adds a row for each camera by itself; returns the error of the best one [mm].
double add_single_cameras(Report& report, const ImportedSet& set,
                          const std::vector<record::FrameRecording>& plain) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < set.recordings.size(); ++c) {
    const auto& view = set.recordings[c];
    const auto& pose = set.world_from_sensor.at(view.sensor);
    const double ours = camera_error_mm(view, pose, set.truth);
    const double rigid = camera_error_mm(plain[c], pose, set.truth);
    report.row("alone-" + view.sensor.str(), "joint_median_mm", ours, "mm", "rigid-pnp",
               ours / rigid);
    best = std::min(best, ours);
  }
  return best;
}

struct Run {
  const char* prefix;
  const std::vector<record::FrameRecording>& views;
  std::optional<Registration> extrinsics;  ///< None: register from the person.
};

/// Runs all methods with one kind of extrinsics; returns the error of the last method.
Result<double> add_methods(Report& report, const Run& run, const ImportedSet& set, double mean_mm) {
  const Registration published = published_registration(set);
  double last = std::numeric_limits<double>::quiet_NaN();
  for (const Case& each : kCases) {
    const auto result =
        pipeline::fuse_offline(tracks_of(run.views), run.extrinsics, config_for(each));
    if (!result) return pass(result);
    if (!result->registration.sensors.contains(result->registration.master)) {
      for (const std::string& reason : result->registration.reasons) report.note(reason);
      return fail(ErrorCode::Unavailable, run.prefix, "no registration came out.");
    }
    const FusedScore fused =
        score(*result, published_from_ours(result->registration, published), set.truth);
    const std::string name = std::string(run.prefix) + "-" + each.name;
    report.row(name, "joint_median_mm", fused.median_mm, "mm", "plain-mean",
               fused.median_mm / mean_mm);
    report.row(name, "joint_p90_mm", fused.p90_mm, "mm");
    report.row(name, "shape_median_mm", fused.shape_mm, "mm");
    report.row(name, "bodies_per_frame", fused.bodies_per_frame, "1");
    last = fused.median_mm;
  }
  return last;
}

/// Fuses the same landmarks as rays, without depth, of two, three and all four cameras; returns the
/// error of all four.
Result<double> add_rays(Report& report, double mean_mm) {
  importers::ImportOptions options;
  options.rays = true;
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {kFolder}, options);
  if (!set) return pass(set);
  const Registration published = published_registration(*set);
  double of_all = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t cameras : {2U, 3U, 4U}) {
    const std::vector views(set->recordings.begin(),
                            set->recordings.begin() + static_cast<std::ptrdiff_t>(cameras));
    const auto result = pipeline::fuse_offline(tracks_of(views), published,
                                               config_for({"rays", Method::PointsAndRays}));
    if (!result) return pass(result);
    const FusedScore fused = score(*result, Eigen::Isometry3d::Identity(), set->truth);
    const std::string name = fmt::format("published-rays-{}-cameras", cameras);
    report.row(name, "joint_median_mm", fused.median_mm, "mm", "plain-mean",
               fused.median_mm / mean_mm);
    report.row(name, "joint_p90_mm", fused.p90_mm, "mm");
    report.row(name, "shape_median_mm", fused.shape_mm, "mm");
    report.row(name, "missing_percent", fused.missing_percent, "%");
    report.row(name, "bodies_per_frame", fused.bodies_per_frame, "1");
    of_all = fused.median_mm;
  }
  return of_all;
}

/// Compares each camera's place, registered from the person alone, with the published one.
Result<void> add_places(Report& report, const ImportedSet& set) {
  const Registration published = published_registration(set);
  const auto result = pipeline::fuse_offline(tracks_of(set.recordings), std::nullopt,
                                             config_for(kCases[std::size(kCases) - 1]));
  if (!result) return pass(result);
  const Registration& ours = result->registration;
  if (!ours.sensors.contains(ours.master))
    return fail(ErrorCode::Unavailable, "registration", "no registration came out.");
  const Eigen::Isometry3d turn = published_from_ours(ours, published);
  for (const auto& [sensor, place] : published.sensors) {
    if (sensor == ours.master) continue;  // both worlds coincide there by definition
    const auto found = ours.sensors.find(sensor);
    const std::string name = "place-" + sensor.str();
    if (found == ours.sensors.end()) {
      report.row(name, "position_mm", std::numeric_limits<double>::quiet_NaN(), "mm");
      continue;
    }
    const Eigen::Isometry3d off =
        place.world_from_sensor.inverse() * turn * found->second.world_from_sensor;
    report.row(name, "position_mm", to_mm(off.translation().norm()), "mm", "published");
    report.row(name, "angle_deg", to_deg(Eigen::AngleAxisd(off.linear()).angle()), "deg",
               "published");
  }
  for (const std::string& reason : ours.reasons) report.note("registration: " + reason);
  return {};
}

/// Error of the method that the data's README describes, fused by the plain mean [mm].
Result<double> plain_mean(Report& report, const ImportedSet& set,
                          const std::vector<record::FrameRecording>& plain) {
  const auto fused =
      pipeline::fuse_offline(tracks_of(plain), published_registration(set), config_for(kCases[0]));
  if (!fused) return pass(fused);
  const double mean_mm = score(*fused, Eigen::Isometry3d::Identity(), set.truth).median_mm;
  report.row("plain-mean", "joint_median_mm", mean_mm, "mm", "elsewhere", mean_mm / kPlainMeanMm);
  return mean_mm;
}

void add_notes(Report& report) {
  report.note(
      "elsewhere: measured outside this project: 104 mm the plain mean, 140 mm the best single "
      "camera");
  report.note(
      "truth: robust triangulation of the same landmarks, their sides chosen for all cameras "
      "together, good to a few centimetres; fusing along the same rays comes near it by "
      "construction, so the last millimetres are agreement, not accuracy");
  report.note("shape_median_mm: after the best rigid motion onto the truth");
  report.note(
      "published-rays-*: only the directions of the landmarks, no perspective-n-point; the first "
      "2, "
      "3 or all cameras; missing: also instants without any body");
  report.note(
      "person-*: registered from the person alone; the world is laid on the published one by the "
      "master");
}

}  // namespace

Result<void> run_real(Report& report) {
  const auto set = importers::import_files(importers::FileFormat::Pose2Sim, {kFolder});
  if (!set) return pass(set);
  const auto plain = plain_views();
  if (!plain) return pass(plain);
  const auto mean = plain_mean(report, *set, *plain);
  if (!mean) return pass(mean);
  const double best_mm = add_single_cameras(report, *set, *plain);

  const auto fused = add_methods(
      report, {"published", set->recordings, published_registration(*set)}, *set, *mean);
  if (!fused) return pass(fused);
  const auto person = add_methods(report, {"person", set->recordings, std::nullopt}, *set, *mean);
  if (!person) return pass(person);
  if (const auto places = add_places(report, *set); !places) return pass(places);
  const auto rays = add_rays(report, *mean);
  if (!rays) return pass(rays);

  report.condition(
      fmt::format("fused with published extrinsics: below {} mm and below the plain mean",
                  kPlainMeanMm),
      *fused < kPlainMeanMm && *fused < *mean);
  report.condition(fmt::format("and below {} mm and the best camera alone", kBestCameraMm),
                   *fused < kBestCameraMm && *fused < best_mm);
  report.condition("rays of four cameras, without any depth: no worse than their points",
                   *rays <= *fused + kNoWorseMm);
  add_notes(report);
  return {};
}

}  // namespace chorus::bench
