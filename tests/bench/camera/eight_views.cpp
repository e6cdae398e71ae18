// Eight real cameras with Vicon truth (totalcapture_views.py makes the folders).
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <Eigen/LU>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rigid_fit.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/camera/four_views.h"
#include "tests/bench/camera/triangulation.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

using fusion::Method;
using importers::ImportedSet;

constexpr double kVicon = 30.0;  // [Hz]
constexpr double kTarget = 0.9;  // Of the offline triangulation.

constexpr std::array kViconJoints{
    JointId::ShoulderLeft, JointId::ShoulderRight, JointId::ElbowLeft, JointId::ElbowRight,
    JointId::WristLeft,    JointId::WristRight,    JointId::HipLeft,   JointId::HipRight,
    JointId::KneeLeft,     JointId::KneeRight,     JointId::AnkleLeft, JointId::AnkleRight};

using Body = Skeleton<WorldSpace>;
/// One body per instant of the truth; none where nobody was found.
using Motion = std::vector<std::optional<Body>>;

std::filesystem::path folder() {
  const char* stated = std::getenv("CHORUS_EIGHT_VIEWS");
  return stated != nullptr ? stated : "../shared/data/totalcapture_views";
}

/// How errors compare with what is stated of them.
struct Stated {
  double nees = 0.0;      ///< Sum of e^T C^-1 e / 3.
  double variance = 0.0;  ///< Sum of the stated variance per axis [m^2].
  double square = 0.0;    ///< Sum of the squared error per axis [m^2].
  double inside = 0.0;    ///< In the stated 95 % ellipsoid.
  double count = 0.0;

  void add(const Eigen::Vector3d& off, const Eigen::Matrix3d& covariance) {
    constexpr double kInside = 7.815;  // 95 % of chi-squared with three degrees of freedom
    const double distance = off.dot(covariance.inverse() * off);
    nees += distance / 3.0;
    variance += covariance.trace() / 3.0;
    square += off.squaredNorm() / 3.0;
    inside += distance <= kInside ? 1.0 : 0.0;
    count += 1.0;
  }
  void add(const Stated& other) {
    nees += other.nees;
    variance += other.variance;
    square += other.square;
    inside += other.inside;
    count += other.count;
  }
};

/// Distances of the twelve joints from the truth.
struct ViconErrors {
  std::vector<double> raw;      ///< [m]
  std::vector<double> aligned;  ///< After one rigid motion of the take [m].
  double missing = 0.0;         ///< Share of the joints.
  double exchanged = 0.0;       ///< Share of the instants with left and right exchanged.
  /// Of each joint, raw and aligned: sums of squared error over stated variance, and of both, per
  /// axis.
  std::array<Stated, kViconJoints.size()> stated{};
  std::array<Stated, kViconJoints.size()> stated_aligned{};
};

double distance(const Body& a, const Body& b, JointId in_a, JointId in_b) {
  return (a[in_a].position - b[in_b].position).norm();
}

bool is_exchanged(const Body& body, const Body& truth) {
  double same = 0.0;
  double other = 0.0;
  for (const JointId id : kViconJoints) {
    if (!body[id].seen() || !body[mirror(id)].seen()) continue;
    same += distance(body, truth, id, id);
    other += distance(body, truth, mirror(id), id);
  }
  return other < same;
}

/// `fit` moves what was found onto the truth.
void add_stated(ViconErrors& errors, const Motion& motion, const ImportedSet& set,
                const Eigen::Isometry3d& fit) {
  for (std::size_t i = 0; i < motion.size(); ++i) {
    for (std::size_t k = 0; motion[i] && k < kViconJoints.size(); ++k) {
      const Joint& joint = (*motion[i])[kViconJoints[k]];
      if (!joint.seen() || !joint.covariance.known()) continue;
      const Eigen::Vector3d& exact = set.truth[i].skeleton[kViconJoints[k]].position;
      const Eigen::Matrix3d covariance = joint.covariance.matrix();
      errors.stated[k].add(joint.position - exact, covariance);
      errors.stated_aligned[k].add(fit * joint.position - exact,
                                   fit.linear() * covariance * fit.linear().transpose());
    }
  }
}

ViconErrors errors_of(const Motion& motion, const ImportedSet& set) {
  ViconErrors errors;
  std::vector<Eigen::Vector3d> found;
  std::vector<Eigen::Vector3d> truth;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const Body& exact = set.truth[i].skeleton;
    if (!motion[i]) continue;
    errors.exchanged += is_exchanged(*motion[i], exact) ? 1.0 : 0.0;
    for (const JointId id : kViconJoints) {
      if (!(*motion[i])[id].seen()) continue;
      found.push_back((*motion[i])[id].position);
      truth.push_back(exact[id].position);
    }
  }
  const auto asked = static_cast<double>(motion.size());
  errors.missing = 1.0 - static_cast<double>(found.size()) / (asked * kViconJoints.size());
  errors.exchanged /= asked;
  const auto fit = fit_rigid(found, truth);
  for (std::size_t i = 0; i < found.size(); ++i) {
    errors.raw.push_back((found[i] - truth[i]).norm());
    if (fit) errors.aligned.push_back((fit->target_from_source * found[i] - truth[i]).norm());
  }
  if (fit) add_stated(errors, motion, set, fit->target_from_source);
  return errors;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? kNoRatio : sum / static_cast<double>(values.size());
}

void add_rows(Report& report, const std::string& name, const ViconErrors& ours,
              const ViconErrors& offline) {
  const auto row = [&](const char* metric, double value, double baseline) {
    report.row(name, metric, to_mm(value), "mm", "offline", value / baseline);
  };
  row("mpjpe_mm", mean(ours.raw), mean(offline.raw));
  row("aligned_mm", mean(ours.aligned), mean(offline.aligned));
  row("median_mm", median(ours.raw), median(offline.raw));
  row("p99_mm", percentile(ours.raw, 0.99), percentile(offline.raw, 0.99));
  report.row(name, "missing_percent", 100.0 * ours.missing, "%");
  report.row(name, "flip_percent", 100.0 * ours.exchanged, "%");
}

void add_stated_rows(Report& report, const std::string& name,
                     const std::array<Stated, kViconJoints.size()>& joints) {
  Stated all;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Stated& each = joints[k];
    all.add(each);
    if (each.count == 0.0) continue;
    report.row(fmt::format("{}-{}", name, name_of(kViconJoints[k])), "nees", each.nees / each.count,
               "1");
  }
  if (all.count == 0.0) return;
  report.row(name, "nees", all.nees / all.count, "1");
  report.row(name, "inside_95_percent", 100.0 * all.inside / all.count, "%");
  report.row(name, "stated_over_true", std::sqrt(all.variance / all.square), "1");
}

/// Every instant by itself, from the same rays.
Motion offline(const ImportedSet& rays) {
  Motion motion(rays.truth.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    std::array<std::vector<SeenAlong>, kJointCount> seen;
    for (const auto& recording : rays.recordings) {
      if (i >= recording.frames.size() || recording.frames[i].bodies.empty()) continue;
      const Eigen::Isometry3d& place = rays.world_from_sensor.at(recording.sensor);
      const auto& joints = recording.frames[i].bodies.front().skeleton.joints;
      for (const JointId id : kViconJoints) {
        const Joint& joint = joints[static_cast<std::size_t>(id)];
        if (joint.state != JointState::Tracked) continue;
        seen[static_cast<std::size_t>(id)].push_back(
            {place.translation(), (place.linear() * joint.position).normalized()});
      }
    }
    motion[i].emplace();
    for (const JointId id : kViconJoints) {
      const auto point = triangulated(seen[static_cast<std::size_t>(id)]);
      if (!point) continue;
      (*motion[i])[id].position = *point;
      (*motion[i])[id].state = JointState::Tracked;
    }
  }
  return motion;
}

struct FusedTake {
  Motion motion;
  double several = 0.0;  ///< Share of the instants with more than one body.
};

/// By the pipeline with the configuration as shipped, except for the method.
Result<FusedTake> fused_by(const ImportedSet& set, Method method) {
  pipeline::OfflineConfig config;
  config.rate_hz = kVicon;
  config.pipeline.fusion.method = method;
  std::vector<registration::WalkTrack> tracks;
  for (const auto& recording : set.recordings)
    tracks.push_back({recording.sensor, recording.frames});
  const auto result = pipeline::fuse_offline(tracks, published_places(set), config);
  if (!result) return pass(result);
  FusedTake fused;
  fused.motion.resize(set.truth.size());
  for (const Snapshot& snapshot : result->snapshots) {
    const double at = seconds(snapshot.instant - importers::kDefaultStart) * kVicon;
    const auto index = static_cast<std::size_t>(std::max(0.0, std::round(at)));
    if (index >= fused.motion.size() || snapshot.bodies.empty()) continue;
    fused.motion[index] = snapshot.bodies.front().skeleton;
    fused.several += snapshot.bodies.size() > 1 ? 1.0 : 0.0;
  }
  fused.several /= static_cast<double>(set.truth.size());
  return fused;
}

struct Way {
  const char* name;
  Method method;
  bool rays;
};
constexpr std::array kWays{Way{"rays", Method::BodyFilter, true},
                           Way{"points", Method::BodyFilter, false},
                           Way{"points-inverse-variance", Method::InverseVariance, false},
                           Way{"points-mean", Method::Mean, false},
                           Way{"points-otto", Method::Otto, false},
                           Way{"points-best-view", Method::BestView, false}};

Result<ImportedSet> take(const std::filesystem::path& path, bool rays) {
  importers::ImportOptions options;
  options.rays = rays;
  auto set = importers::import_files(importers::FileFormat::Pose2Sim, {path}, options);
  if (set) {
    for (const auto& recording : set->recordings) {
      if (set->truth.size() > recording.frames.size()) set->truth.resize(recording.frames.size());
    }
  }
  return set;
}

Result<void> measure(Report& report, const std::filesystem::path& path) {
  const auto rays = take(path, true);
  if (!rays) return pass(rays);
  const auto points = take(path, false);
  if (!points) return pass(points);
  const std::string name = "eight-views-vicon-" + path.filename().string();
  const ViconErrors baseline = errors_of(offline(*rays), *rays);
  add_rows(report, name + "-offline", baseline, baseline);
  for (const Way& way : kWays) {
    const ImportedSet& set = way.rays ? *rays : *points;
    const auto fused = fused_by(set, way.method);
    if (!fused) return pass(fused);
    const ViconErrors ours = errors_of(fused->motion, set);
    const std::string row = fmt::format("{}-{}", name, way.name);
    add_rows(report, row, ours, baseline);
    report.row(row, "several_bodies_percent", 100.0 * fused->several, "%");
    if (way.method == Method::BodyFilter) {
      add_stated_rows(report, row, ours.stated);
      add_stated_rows(report, row + "-aligned", ours.stated_aligned);
    }
    if (way.method == Method::BodyFilter)
      report.condition(row + ": at most 0.9 of the offline triangulation of the same landmarks",
                       mean(ours.raw) <= kTarget * mean(baseline.raw));
  }
  return {};
}

}  // namespace

std::vector<std::filesystem::path> eight_view_takes() {
  std::vector<std::filesystem::path> takes;
  std::error_code missing;
  for (const auto& entry : std::filesystem::directory_iterator(folder(), missing)) {
    if (std::filesystem::exists(entry.path() / "cameras.json")) takes.push_back(entry.path());
  }
  std::ranges::sort(takes);
  return takes;
}

Result<void> eight_views(Report& report) {
  const auto takes = eight_view_takes();
  if (takes.empty())
    report.note(
        fmt::format("eight-views-vicon: left out, {} has no takes; the data may not be "
                    "distributed, see tests/bench/camera/totalcapture_views.py",
                    folder().string()));
  for (const auto& path : takes) {
    if (const auto done = measure(report, path); !done) return done;
  }
  return {};
}

}  // namespace chorus::bench
