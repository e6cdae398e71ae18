#include "common/characteristics/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Dense>

#include "common/base/duration.h"
#include "common/base/units.h"
#include "common/body/interpolate.h"

namespace chorus::characteristics {
namespace {

constexpr std::array kUpperSpine{JointId::Neck, JointId::SpineShoulder};
// Widest gap between two frames that is interpolated, as in align [s].
constexpr double kWidest = 0.12;
constexpr std::size_t kLeastPairs = 100;
constexpr double kStart = mm(15);  // what is expected at first [m]
constexpr int kRounds = 5;
constexpr double kLeastSigma = mm(0.1);
constexpr double kParallel = 0.1;  // sine of the angle between lines of sight that hardly differ
// Views that differ by more show two people, or have other labels [m].
constexpr double kStrangers = 0.3;

/// A joint in the world, and the line of sight to it.
struct Seen {
  Eigen::Vector3d point;
  Eigen::Vector3d sight;
};

/// One difference along one direction.
struct Sample {
  double square = 0.0;  ///< [m^2]
  double sights = 0.0;  ///< (e.u)^2 + (e.v)^2
};

/// The joint of the only body; not tracked if there is none, or several.
Joint joint_in(const SensorFrame& frame, JointId id) {
  return frame.bodies.size() == 1 ? frame.bodies.front().skeleton[id] : Joint{};
}

bool tracked(const Joint& joint) { return joint.seen() && joint.state == JointState::Tracked; }

Seen seen_from(const Eigen::Isometry3d& world_from_sensor, const Eigen::Vector3d& at) {
  return {world_from_sensor * at, (world_from_sensor.linear() * at).normalized()};
}

/// The joint at an instant between two frames, not tracked unless it is in both; `next` is the
/// first frame after the instant.
Joint between(const std::vector<SensorFrame>& frames, std::size_t next, Timestamp at, JointId id) {
  if (next == 0 || next >= frames.size()) return {};
  const SensorFrame& before = frames[next - 1];
  const double gap = seconds(frames[next].captured - before.captured);
  if (gap > kWidest || gap <= 0) return {};
  const double share = seconds(at - before.captured) / gap;
  return interpolate(joint_in(before, id), joint_in(frames[next], id), share);
}

/// False if the pair tells nothing of both errors: of two people, or from one direction.
bool add_pair(std::vector<Sample>& samples, const Seen& one, const Seen& other) {
  const Eigen::Vector3d apart = one.point - other.point;
  const Eigen::Vector3d normal = one.sight.cross(other.sight);
  const Eigen::Vector3d sum = one.sight + other.sight;
  const Eigen::Vector3d difference = one.sight - other.sight;
  if (apart.norm() > kStrangers) return false;
  for (const Eigen::Vector3d& direction : {normal, sum, difference}) {
    if (direction.norm() < kParallel) continue;
    const Eigen::Vector3d e = direction.normalized();
    const double u = e.dot(one.sight);
    const double v = e.dot(other.sight);
    samples.push_back({std::pow(e.dot(apart), 2), u * u + v * v});
  }
  return normal.norm() >= kParallel;
}

std::size_t add_tracks(std::vector<Sample>& samples, const PlacedTrack& one,
                       const PlacedTrack& other) {
  std::size_t next = 0;
  std::size_t pairs = 0;
  for (const SensorFrame& frame : *one.frames) {
    while (next < other.frames->size() && (*other.frames)[next].captured <= frame.captured) ++next;
    for (const JointId id : kUpperSpine) {
      const Joint here = joint_in(frame, id);
      const Joint there = between(*other.frames, next, frame.captured, id);
      if (!tracked(here) || !tracked(there)) continue;
      const bool tells = add_pair(samples, seen_from(one.world_from_sensor, here.position),
                                  seen_from(other.world_from_sensor, there.position));
      pairs += tells ? 1 : 0;
    }
  }
  return pairs;
}

/// across^2 and along^2 - across^2 by weighted least squares.
Eigen::Vector2d solve(const std::vector<Sample>& samples) {
  Eigen::Vector2d found(kStart * kStart, 0.0);
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Identity() * 1e-12;
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (const Sample& sample : samples) {
      const Eigen::Vector2d row(2.0, sample.sights);
      const double expected = std::max(row.dot(found), 2 * kLeastSigma * kLeastSigma);
      normal += row * row.transpose() / (expected * expected);
      right += row * sample.square / (expected * expected);
    }
    found = normal.ldlt().solve(right);
  }
  return found;
}

}  // namespace

std::optional<Agreement> agreement_of(const std::vector<PlacedTrack>& tracks) {
  std::vector<Sample> samples;
  Agreement agreement;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    for (std::size_t j = i + 1; j < tracks.size(); ++j)
      agreement.pairs += add_tracks(samples, tracks[i], tracks[j]);
  }
  if (agreement.pairs < kLeastPairs) return std::nullopt;
  const Eigen::Vector2d found = solve(samples);
  agreement.across = std::sqrt(std::max(found[0], kLeastSigma * kLeastSigma));
  agreement.along = std::sqrt(std::max(found[0] + found[1], kLeastSigma * kLeastSigma));
  return agreement;
}

}  // namespace chorus::characteristics
