#include "tests/bench/accuracy/recordings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "common/base/units.h"
#include "common/geometry/rigid_fit.h"
#include "common/importers/datasets/keraal_text.h"
#include "common/importers/text_rows.h"
#include "fusion-server/pipeline/offline.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using importers::LineReader;
using importers::Row;
using record::FrameRecording;
using enum JointId;

constexpr double kKinectRate = 30.0;  // [Hz]

double rms(const std::vector<double>& errors) {
  double sum = 0.0;
  for (const double error : errors) sum += error * error;
  return errors.empty() ? std::nan("") : std::sqrt(sum / static_cast<double>(errors.size()));
}

/// An optical target, which sits on the skin of a limb.  It is compared with the midpoint of the
/// limb's two joints.
struct Target {
  const char* name;
  JointId from;
  JointId to;
};
constexpr std::array<Target, 17> kTargets{{{"forearm_right", ElbowRight, WristRight},
                                           {"forearm_left", ElbowLeft, WristLeft},
                                           {"arm_right", ShoulderRight, ElbowRight},
                                           {"arm_left", ShoulderLeft, ElbowLeft},
                                           {"chest", SpineMid, SpineShoulder},
                                           {"thigh_right", HipRight, KneeRight},
                                           {"thigh_left", HipLeft, KneeLeft},
                                           {"shoulder_right", ShoulderRight, ShoulderRight},
                                           {"shoulder_left", ShoulderLeft, ShoulderLeft},
                                           {"hand_right", HandRight, HandRight},
                                           {"hand_left", HandLeft, HandLeft},
                                           {"foot_right", FootRight, FootRight},
                                           {"foot_left", FootLeft, FootLeft},
                                           {"hips", SpineBase, SpineBase},
                                           {"head", Head, Head},
                                           {"tibia_right", KneeRight, AnkleRight},
                                           {"tibia_left", KneeLeft, AnkleLeft}}};

struct OpticalFrame {
  std::array<Eigen::Vector3d, kTargets.size()> position;
  std::array<Eigen::Quaterniond, kTargets.size()> world_from_target;
};

/// Rows of 17 x (x y z [mm] qx qy qz qw), with a trailing blank.
Result<std::vector<OpticalFrame>> read_optical(const fs::path& file) {
  constexpr std::size_t kPerTarget = 7;
  const auto text = importers::read_bounded(file, 64u << 20);
  if (!text) return pass(text);
  LineReader lines(*text, file.string());
  std::vector<OpticalFrame> frames;
  while (const auto line = lines.next_filled()) {
    const auto row = Row::split(lines, *line, ' ', kPerTarget * kTargets.size());
    if (!row) return pass(row);
    OpticalFrame& frame = frames.emplace_back();
    for (std::size_t i = 0; i < kTargets.size(); ++i) {
      std::array<double, kPerTarget> n{};
      if (auto ok = row->numbers(kPerTarget * i, n, 1e5); !ok) return pass(ok);
      frame.position[i] = Eigen::Vector3d(n[0], n[1], n[2]) * mm(1);
      frame.world_from_target[i] = Eigen::Quaterniond(n[6], n[3], n[4], n[5]).normalized();
    }
  }
  return frames;
}

using Bodies = std::vector<Skeleton<WorldSpace>>;

/// Kinect at 30 Hz and optical at 60 Hz: frame i corresponds to optical frame 2 i + shift.
struct Take {
  Bodies bodies;
  std::vector<OpticalFrame> optical;
  int shift = 0;

  [[nodiscard]] const OpticalFrame* at(std::size_t frame) const {
    const auto index = static_cast<std::ptrdiff_t>(2 * frame) + shift;
    const auto inside = bodies[frame][SpineBase].seen() && index >= 0 &&
                        index < static_cast<std::ptrdiff_t>(optical.size());
    return inside ? &optical[static_cast<std::size_t>(index)] : nullptr;
  }
};

struct Fit {
  Eigen::Isometry3d optical_from_kinect = Eigen::Isometry3d::Identity();
  double rms = std::numeric_limits<double>::infinity();
};

Eigen::Vector3d middle(const Skeleton<WorldSpace>& body, const Target& target) {
  return 0.5 * (body[target.from].position + body[target.to].position);
}

Fit fit(const Take& take) {
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  for (std::size_t f = 0; f < take.bodies.size(); ++f) {
    const OpticalFrame* optical = take.at(f);
    if (optical == nullptr) continue;
    for (std::size_t i = 0; i < kTargets.size(); ++i) {
      source.push_back(middle(take.bodies[f], kTargets[i]));
      target.push_back(optical->position[i]);
    }
  }
  const auto found = fit_rigid(source, target);
  return found ? Fit{found->target_from_source, found->rms} : Fit{};
}

/// The two recordings start some optical frames apart: finds the shift that fits best.
void find_shift(Take& take) {
  Fit best;
  int chosen = 0;
  for (int shift = -20; shift <= 20; ++shift) {
    take.shift = shift;
    if (const Fit found = fit(take); found.rms < best.rms) {
      best = found;
      chosen = shift;
    }
  }
  take.shift = chosen;
}

/// rms distance of all targets from their limbs after the best rigid motion; `own_place`: each
/// target's mean offset from its limb, in the target's axes, is subtracted first.
double take_rms(const Take& take, bool own_place) {
  const Fit motion = fit(take);
  std::vector<double> errors;
  for (std::size_t i = 0; i < kTargets.size(); ++i) {
    std::vector<Eigen::Vector3d> offsets;  // in target axes
    for (std::size_t f = 0; f < take.bodies.size(); ++f) {
      const OpticalFrame* optical = take.at(f);
      if (optical == nullptr) continue;
      const Eigen::Vector3d off =
          motion.optical_from_kinect * middle(take.bodies[f], kTargets[i]) - optical->position[i];
      offsets.emplace_back(optical->world_from_target[i].conjugate() * off);
    }
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const auto& off : offsets) mean += off / static_cast<double>(offsets.size());
    for (const auto& off : offsets)
      errors.push_back((off - (own_place ? mean : Eigen::Vector3d::Zero())).norm());
  }
  return rms(errors);
}

Bodies raw_bodies(const FrameRecording& recording) {
  Bodies bodies;
  for (const SensorFrame& frame : recording.frames) {
    bodies.push_back(to_world(Eigen::Isometry3d::Identity(), frame.bodies.at(0).skeleton));
  }
  return bodies;
}

/// Bodies after the whole pipeline with one sensor, frame by frame; empty where there is none.
Result<Bodies> fused_bodies(const FrameRecording& recording) {
  Registration given;
  given.master = recording.sensor;
  given.sensors[recording.sensor].chain = {recording.sensor};
  const auto fused = pipeline::fuse_offline({{recording.sensor, recording.frames}}, given, {});
  if (!fused) return pass(fused);
  Bodies bodies(recording.frames.size());
  for (const Snapshot& snapshot : fused->snapshots) {
    const double index =
        seconds(snapshot.instant - recording.frames.front().captured) * kKinectRate;
    const auto at = static_cast<std::size_t>(std::max(0.0, std::round(index)));
    if (!snapshot.bodies.empty() && at < bodies.size())
      bodies[at] = snapshot.bodies.front().skeleton;
  }
  return bodies;
}

double share_seen(const Bodies& bodies) {
  const auto seen = std::count_if(bodies.begin(), bodies.end(),
                                  [](const auto& body) { return body[SpineBase].seen(); });
  return static_cast<double>(seen) / static_cast<double>(std::max<std::size_t>(1, bodies.size()));
}

}  // namespace

Result<void> compare_with_keraal(Report& report, const std::filesystem::path& folder) {
  const auto kinect = importers::read_keraal_text(folder / "G3-Kinect-CTK-P1T1-Unknown-C-0.txt");
  if (!kinect) return pass(kinect);
  auto optical = read_optical(folder / "G3-Vicon-CTK-P1T1-Unknown-C-0.txt");
  if (!optical) return pass(optical);
  auto fused = fused_bodies(*kinect);
  if (!fused) return pass(fused);
  Take raw{raw_bodies(*kinect), *optical};
  find_shift(raw);
  const Take ours{std::move(*fused), std::move(*optical), raw.shift};
  const double before = take_rms(raw, false);
  report.row("keraal-ctk", "kinect_to_target_rms_mm", to_mm(before), "mm");
  report.row("keraal-ctk", "kinect_rms_own_place_mm", to_mm(take_rms(raw, true)), "mm");
  report.row("keraal-ctk", "through_pipeline_rms_mm", to_mm(take_rms(ours, false)), "mm", "kinect",
             take_rms(ours, false) / before);
  report.row("keraal-ctk", "through_pipeline_frames_percent", 100 * share_seen(ours.bodies), "%");
  report.row("keraal-ctk", "start_shift_frames", raw.shift, "of 60 Hz");
  report.condition("keraal-ctk: the pipeline answers more than 95 % of the frames",
                   share_seen(ours.bodies) > 0.95);
  report.condition("keraal-ctk: the pipeline of one sensor adds less than 5 %",
                   take_rms(ours, false) < 1.05 * before);
  return {};
}

}  // namespace chorus::bench
