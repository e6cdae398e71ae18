// Left and right in single-sensor recordings after the whole pipeline.
//
// In most collections people face the sensor, so the sensor's labels are taken for the truth.  In
// NW-UCLA they walk about, and the direction of walking is the truth; seen from behind, their
// labels are swapped.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/importers/datasets/keraal_text.h"
#include "common/importers/datasets/labanotation_csv.h"
#include "common/importers/datasets/ntu_skeleton.h"
#include "common/importers/datasets/nw_ucla_json.h"
#include "fusion-server/facing/posture.h"
#include "fusion-server/pipeline/offline.h"
#include "tests/bench/accuracy/recordings.h"
#include "tests/judge/labelled_error.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using record::FrameRecording;

using Body = Skeleton<WorldSpace>;

/// What is known about the labels of one body.
struct Truth {
  bool as_labelled = true;  ///< The sensor's own left and right are correct.
};
using Judge =
    std::function<std::optional<Truth>(const FrameRecording&, std::size_t index, const Body& raw)>;

struct Share {
  std::size_t right = 0;
  std::size_t all = 0;

  void add(bool is_right) {
    right += is_right ? 1 : 0;
    ++all;
  }
  [[nodiscard]] double percent() const {
    return all == 0 ? kNoRatio : 100.0 * static_cast<double>(right) / static_cast<double>(all);
  }
};

struct Shares {
  Share as_labelled;  ///< Bodies whose labels by the sensor are correct.
  Share exchanged;    ///< Bodies whose labels by the sensor are swapped.
};

/// The sensor's body nearest to a fused one; null if none is within 0.3 m.
const BodyFrame* nearest(const SensorFrame& frame, const Body& fused) {
  const BodyFrame* best = nullptr;
  double least = 0.3;  // [m]
  for (const BodyFrame& body : frame.bodies) {
    const double off =
        (body.skeleton[JointId::SpineMid].position - fused[JointId::SpineMid].position).norm();
    if (off < least) {
      least = off;
      best = &body;
    }
  }
  return best;
}

std::size_t index_at(const FrameRecording& recording, Timestamp instant) {
  const auto later =
      std::ranges::lower_bound(recording.frames, instant, {}, &SensorFrame::captured);
  const auto index = static_cast<std::size_t>(later - recording.frames.begin());
  if (index == 0) return 0;
  const bool before = index == recording.frames.size() ||
                      instant - recording.frames[index - 1].captured < later->captured - instant;
  return before ? index - 1 : index;
}

Result<void> count(const FrameRecording& recording, const Judge& judge, Shares& shares) {
  Registration given;
  given.master = recording.sensor;
  given.sensors[recording.sensor].chain = {recording.sensor};
  const auto fused = pipeline::fuse_offline({{recording.sensor, recording.frames}}, given, {});
  if (!fused) return pass(fused);
  for (const Snapshot& snapshot : fused->snapshots) {
    const std::size_t index = index_at(recording, snapshot.instant);
    for (const FusedBody& body : snapshot.bodies) {
      const BodyFrame* seen = nearest(recording.frames[index], body.skeleton);
      if (seen == nullptr) continue;
      const Body raw = to_world(Eigen::Isometry3d::Identity(), seen->skeleton);
      const auto truth = judge(recording, index, raw);
      if (!truth) continue;
      const LabelledError error = labelled_error(body.skeleton, raw);
      const bool kept = error.as_given <= error.exchanged;
      (truth->as_labelled ? shares.as_labelled : shares.exchanged).add(kept == truth->as_labelled);
    }
  }
  return {};
}

std::optional<Truth> labels_are_right(const FrameRecording&, std::size_t, const Body&) {
  return Truth{};
}

/// Judges the labels by the direction in which the body moves within eight frames.
std::optional<Truth> walks_forwards(const FrameRecording& recording, std::size_t index,
                                    const Body& raw) {
  constexpr std::size_t kFrames = 4;
  constexpr double kWalks = 0.4;  // [m/s]
  constexpr double kAlong = 0.5;  // cosine of the angle to the front
  if (index < kFrames || index + kFrames >= recording.frames.size()) return std::nullopt;
  const auto& before = recording.frames[index - kFrames];
  const auto& after = recording.frames[index + kFrames];
  Eigen::Vector3d way = after.bodies.at(0).skeleton[JointId::SpineMid].position -
                        before.bodies.at(0).skeleton[JointId::SpineMid].position;
  way.y() = 0;
  Eigen::Vector3d left = raw[JointId::ShoulderLeft].position - raw[JointId::ShoulderRight].position;
  left.y() = 0;
  if (way.norm() < kWalks * seconds(after.captured - before.captured) || left.norm() < 0.05)
    return std::nullopt;
  const double along = way.normalized().dot(left.normalized().cross(Eigen::Vector3d::UnitY()));
  if (std::abs(along) < kAlong) return std::nullopt;
  return Truth{along > 0};
}

/// What toes say of the side on which the left is, in frames in which they say anything.
struct Toes {
  Share gated;           ///< Toes that point away from the sensor, as the facing stage takes them.
  Share all;             ///< Toes wherever they point.
  std::size_t seen = 0;  ///< Frames whose truth is known.

  void add(const Body& raw, bool as_labelled) {
    ++seen;
    Eigen::Vector3d left =
        raw[JointId::ShoulderLeft].position - raw[JointId::ShoulderRight].position;
    left.y() = 0;
    left = (as_labelled ? 1.0 : -1.0) * left.normalized();
    facing::PostureCues feet_alone;
    for (auto cue :
         {&facing::PostureCues::knees, &facing::PostureCues::wrists, &facing::PostureCues::elbows,
          &facing::PostureCues::lean, &facing::PostureCues::hidden})
      (feet_alone.*cue).log_odds = 0.0;
    SensorView view;
    view.skeleton = raw;
    constexpr double kSays = 0.2;
    const double odds = facing::posture_log_odds({view}, left, 1.0, feet_alone);
    if (std::abs(odds) > kSays) gated.add(odds > 0);
    const Eigen::Vector3d front = left.cross(Eigen::Vector3d::UnitY());
    const double ahead =
        front.dot(raw[JointId::FootLeft].position - raw[JointId::AnkleLeft].position +
                  raw[JointId::FootRight].position - raw[JointId::AnkleRight].position);
    all.add(ahead > 0);
  }

  void report(Report& to, const std::string& name, const std::string& where) const {
    to.row(name, "says_percent" + where,
           100.0 * static_cast<double>(gated.all) /
               static_cast<double>(std::max<std::size_t>(1, seen)),
           "%");
    to.row(name, "right_percent" + where, gated.percent(), "%", "all-toes",
           gated.percent() / all.percent());
  }
};

using Reader = Result<FrameRecording> (*)(const fs::path&, const importers::ImportOptions&);

struct Collection {
  const char* name;
  const char* ending;  ///< How the names of the files end.
  const char* beginning;
  Reader read;
  Judge judge;
  /// Required share of correct results where the labels are right; 0: only reported.
  double least_percent;
};

Result<void> count_all(Report& report, const fs::path& folder, const Collection& each) {
  Shares shares;
  std::size_t files = 0;
  double worst = 100.0;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (!name.starts_with(each.beginning) || !name.ends_with(each.ending)) continue;
    const auto recording = each.read(file.path(), {});
    if (!recording) continue;
    Shares own;
    if (auto done = count(*recording, each.judge, own); !done) return done;
    ++files;
    if (own.as_labelled.all > 0) worst = std::min(worst, own.as_labelled.percent());
    for (auto part : {&Shares::as_labelled, &Shares::exchanged}) {
      (shares.*part).right += (own.*part).right;
      (shares.*part).all += (own.*part).all;
    }
  }
  const std::string name = fmt::format("sides-{}", each.name);
  report.row(name, "files", static_cast<double>(files), "files");
  report.row(name, "right_percent", shares.as_labelled.percent(), "%");
  report.row(name, "right_percent_worst_file", worst, "%");
  if (shares.exchanged.all > 0)
    report.row(name, "right_percent_where_exchanged", shares.exchanged.percent(), "%");
  if (each.least_percent > 0)
    report.condition(
        fmt::format("{}: right in at least {} % of the frames", name, each.least_percent),
        shares.as_labelled.percent() >= each.least_percent);
  return {};
}

constexpr double kTarget = 96.0;  // [%]

}  // namespace

Result<void> side_labanotation(Report& report, const fs::path& folder) {
  return count_all(
      report, folder,
      {"labanotation", ".csv", "", importers::read_labanotation_csv, labels_are_right, kTarget});
}

Result<void> side_keraal(Report& report, const fs::path& folder) {
  return count_all(
      report, folder,
      {"keraal", ".txt", "G3-Kinect", importers::read_keraal_text, labels_are_right, kTarget});
}

Result<void> side_ntu(Report& report, const fs::path& folder) {
  return count_all(
      report, folder,
      {"ntu", ".skeleton", "", importers::read_ntu_skeleton, labels_are_right, kTarget});
}

/// In NW-UCLA's walks: is what the toes say of the sides right, where the labels are and where they
/// are exchanged?
Result<void> toes_nw_ucla(Report& report, const fs::path& folder) {
  Toes as_labelled;
  Toes exchanged;
  for (const auto& file : fs::recursive_directory_iterator(folder)) {
    const std::string name = file.path().filename().string();
    if (!name.starts_with("a04") || !name.ends_with(".json")) continue;
    const auto recording = importers::read_nw_ucla_json(file.path(), {});
    if (!recording) continue;
    for (std::size_t i = 0; i < recording->frames.size(); ++i) {
      if (recording->frames[i].bodies.empty()) continue;
      const Body raw =
          to_world(Eigen::Isometry3d::Identity(), recording->frames[i].bodies.front().skeleton);
      const auto truth = walks_forwards(*recording, i, raw);
      if (truth) (truth->as_labelled ? as_labelled : exchanged).add(raw, truth->as_labelled);
    }
  }
  as_labelled.report(report, "toes-nw-ucla-walk", "");
  exchanged.report(report, "toes-nw-ucla-walk", "_where_exchanged");
  return {};
}

Result<void> side_nw_ucla(Report& report, const fs::path& folder) {
  return count_all(
      report, folder,
      {"nw-ucla-walk", ".json", "a04", importers::read_nw_ucla_json, walks_forwards, 0.0});
}

}  // namespace chorus::bench
