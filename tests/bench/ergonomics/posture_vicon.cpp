// Eight real cameras and Vicon: the folders that chorus-bench camera --only eight-views-vicon
// reads. One part of a person's stance is theirs: the calmest upright stretch of what was fused.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include "common/importers/formats.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/ergonomics/ergonomics_cases.h"
#include "tests/bench/ergonomics/posture_agreement.h"

namespace chorus::bench {
namespace {

using importers::ImportedSet;

constexpr double kViewsHz = 30.0;  // [Hz]

std::filesystem::path views_folder() {
  const char* stated = std::getenv("CHORUS_EIGHT_VIEWS");
  return stated != nullptr ? stated : "../shared/data/totalcapture_views";
}

/// Published places of some of the cameras.
Registration places_of(const ImportedSet& set, std::size_t first, std::size_t count) {
  Registration registration;
  registration.version = 1;
  registration.verdict = Verdict::Good;
  for (std::size_t i = first; i < first + count; ++i) {
    const SensorId& sensor = set.recordings[i].sensor;
    if (i == first) registration.master = sensor;
    registration.sensors[sensor].world_from_sensor = set.world_from_sensor.at(sensor);
  }
  return registration;
}

ergonomics::BodyAt body_of(const FusedBody& fused, Timestamp at) {
  ergonomics::BodyAt body{at, fused.skeleton, fused.sides_confidence.value_or(1.0),
                          fused.carried_for.has_value()};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.body.joints[j];
    if (!joint.covariance.known() && fused.variance[j] > 0.0)
      joint.covariance = Covariance(Eigen::Matrix3d::Identity() * fused.variance[j]);
  }
  return body;
}

struct Cameras {
  std::size_t first = 0;
  std::size_t count = 0;
};

Result<ScoredTake> fused_take(const ImportedSet& set, fusion::Method method, Cameras cameras) {
  pipeline::OfflineConfig config;
  config.rate_hz = kViewsHz;
  config.pipeline.fusion.method = method;
  std::vector<registration::WalkTrack> tracks;
  for (std::size_t i = cameras.first; i < cameras.first + cameras.count; ++i)
    tracks.push_back({set.recordings[i].sensor, set.recordings[i].frames});
  const auto result =
      pipeline::fuse_offline(tracks, places_of(set, cameras.first, cameras.count), config);
  if (!result) return pass(result);
  ScoredTake take;
  for (std::size_t i = 0; i < set.truth.size(); ++i) {
    const Timestamp at =
        importers::kDefaultStart + Duration(std::llround(1e9 * static_cast<double>(i) / kViewsHz));
    take.truth.push_back({at, set.truth[i].skeleton});
    take.found.push_back({at, {}});
  }
  for (const Snapshot& snapshot : result->snapshots) {
    const double at =
        std::chrono::duration<double>(snapshot.instant - importers::kDefaultStart).count() *
        kViewsHz;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    if (index >= take.found.size() || snapshot.bodies.empty()) continue;
    take.found[index] = body_of(snapshot.bodies.front(), take.found[index].at);
  }
  return take;
}

/// world_from_head of the takes' gt_skel_gbl_ori.txt (60 Hz; of its 21 segments, x y z w, the
/// seventh).  The segments' axes lie to the right, back and down.
Result<std::vector<Eigen::Quaterniond>> true_heads(const std::filesystem::path& file) {
  constexpr std::size_t kHead = 6;
  std::vector<Eigen::Quaterniond> heads;
  Eigen::Matrix3d ours;
  ours << -1, 0, 0, 0, 0, -1, 0, -1, 0;
  std::ifstream lines(file);
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    const std::vector<double> numbers{std::istream_iterator<double>(words), {}};
    if (numbers.empty()) continue;
    if (numbers.size() != 21 * 4)
      return fail(ErrorCode::Malformed, file.string(), "must have 21 quaternions a line");
    const double* q = &numbers[4 * kHead];
    heads.emplace_back(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized() *
                       Eigen::Quaterniond(ours));
  }
  return heads;
}

/// The true bodies' heads are turned as Vicon says.
Result<void> turn_heads(const std::filesystem::path& take, ImportedSet& set) {
  const auto heads = true_heads(take / "gt_skel_gbl_ori.txt");
  if (!heads) return pass(heads);
  for (std::size_t i = 0; i < set.truth.size() && 2 * i < heads->size(); ++i)
    set.truth[i].skeleton[JointId::Head].orientation = (*heads)[2 * i];
  return {};
}

Result<ImportedSet> read_take(const std::filesystem::path& path, bool rays) {
  importers::ImportOptions options;
  options.rays = rays;
  auto set = importers::import_files(importers::FileFormat::Pose2Sim, {path}, options);
  if (!set) return set;
  for (const auto& recording : set->recordings) {
    if (set->truth.size() > recording.frames.size()) set->truth.resize(recording.frames.size());
  }
  if (auto turned = turn_heads(path, *set); !turned) return pass(turned);
  return set;
}

struct ViewSet {
  ImportedSet rays;
  ImportedSet points;
};

/// All takes, fused in one way and compared.
Result<PostureAgreement> compared(const std::vector<ViewSet>& sets, bool rays,
                                  fusion::Method method, const PostureOptions& options) {
  PostureAgreement sum;
  for (const ViewSet& set : sets) {
    const ImportedSet& used = rays ? set.rays : set.points;
    const auto take = fused_take(used, method, {0, used.recordings.size()});
    if (!take) return pass(take);
    compare_postures(*take, options, sum);
  }
  return sum;
}

/// The camera whose level agrees best, by itself.
Result<PostureAgreement> best_camera(const std::vector<ViewSet>& sets) {
  PostureAgreement best;
  for (std::size_t camera = 0; camera < sets.front().points.recordings.size(); ++camera) {
    PostureAgreement sum;
    for (const ViewSet& set : sets) {
      const auto take = fused_take(set.points, fusion::Method::BodyFilter, {camera, 1});
      if (!take) return pass(take);
      compare_postures(*take, {}, sum);
    }
    if (best.of[1].count() == 0 || sum.of[1].weighted_kappa() > best.of[1].weighted_kappa())
      best = sum;
  }
  return best;
}

void add_conditions(Report& report, const PostureAgreement& ours) {
  const auto at_least = [&](const char* what, double value, double target) {
    report.condition(fmt::format("real-vicon: {} at least {:.2f} (is {:.2f})", what, target, value),
                     value >= target);
  };
  at_least("REBA level, weighted kappa", ours.of[1].weighted_kappa(), 0.82);
  at_least("REBA level, kappa", ours.of[1].kappa(), 0.66);
  at_least("REBA score, weighted kappa", ours.of[0].weighted_kappa(), 0.82);
  at_least("OWAS back, kappa", ours.of[6].kappa(), 0.60);
  at_least("OWAS arms, kappa", ours.of[7].kappa(), 0.80);
  at_least("OWAS legs, kappa", ours.of[8].kappa(), 0.90);
  at_least("EAWS-like class, kappa", ours.of[10].kappa(), 0.85);
  at_least("neck, kappa", ours.of[4].kappa(), 0.40);
}

}  // namespace

Result<void> posture_real_vicon(Report& report) {
  std::vector<ViewSet> sets;
  std::error_code missing;
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(views_folder(), missing)) {
    if (std::filesystem::exists(entry.path() / "cameras.json")) paths.push_back(entry.path());
  }
  std::ranges::sort(paths);
  for (const auto& path : paths) {
    auto rays = read_take(path, true);
    if (!rays) return pass(rays);
    auto points = read_take(path, false);
    if (!points) return pass(points);
    sets.push_back({std::move(*rays), std::move(*points)});
  }
  if (sets.empty()) {
    report.note(
        fmt::format("real-vicon: left out, {} has no takes; the data may not be "
                    "distributed, see tests/bench/camera/totalcapture_views.py",
                    views_folder().string()));
    return {};
  }
  struct Way {
    const char* name;
    bool rays;
    fusion::Method method;
    PostureOptions options;
  };
  const std::array ways{
      Way{"real-vicon", true, fusion::Method::BodyFilter, {}},
      Way{"real-vicon-instant", true, fusion::Method::BodyFilter, {.held = false}},
      Way{"real-vicon-no-stance", true, fusion::Method::BodyFilter, {.stance = false}},
      Way{"real-vicon-mean", false, fusion::Method::Mean, {}},
      Way{"real-vicon-best-view", false, fusion::Method::BestView, {}}};
  for (const Way& way : ways) {
    if (report.quick() && way.name != std::string("real-vicon")) continue;  // minutes each
    const auto sum = compared(sets, way.rays, way.method, way.options);
    if (!sum) return pass(sum);
    report_agreement(report, way.name, *sum);
    if (way.rays) report_doubt(report, way.name, *sum);
    if (way.name == std::string("real-vicon")) add_conditions(report, *sum);
  }
  if (report.quick()) return {};
  const auto single = best_camera(sets);
  if (!single) return pass(single);
  report_agreement(report, "real-vicon-best-camera", *single);
  report.note(
      "real-vicon: the held posture is the median over the last second, half a second late; "
      "both sides are delayed alike");
  return {};
}

}  // namespace chorus::bench
