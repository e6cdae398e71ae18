#include "fusion-server/facing/posture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/body/bones.h"

namespace chorus::facing {
namespace {

constexpr double kGuessedOffset = 0.3;  // Weight of an offset that depends on an inferred joint.

/// Weighted mean of offsets in world space [m].
struct Offset {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double weight = 0.0;

  void add(const Eigen::Vector3d& offset, double by) {
    sum += by * offset;
    weight += by;
  }
  [[nodiscard]] double along(const Eigen::Vector3d& direction) const {
    return weight > 0 ? sum.dot(direction) / weight : 0.0;
  }
};

/// Weight of these joints together: 0 if one is not seen, less than 1 if one is inferred.
template <class... Ids>
double weight_of(const Skeleton<WorldSpace>& body, Ids... ids) {
  const bool seen = (body[ids].seen() && ...);
  const bool tracked = ((body[ids].state == JointState::Tracked) && ...);
  return seen ? (tracked ? 1.0 : kGuessedOffset) : 0.0;
}

/// Offset of `p` from the nearest point of the segment from `a` to `b`; zero if these nearly
/// coincide.
Eigen::Vector3d off_line(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                         const Eigen::Vector3d& b) {
  constexpr double kMinLength = 1e-4;  // [m^2]
  const Eigen::Vector3d line = b - a;
  if (line.squaredNorm() < kMinLength) return Eigen::Vector3d::Zero();
  const double t = std::clamp((p - a).dot(line) / line.squaredNorm(), 0.0, 1.0);
  return p - a - t * line;
}

struct Limb {
  JointId root;
  JointId middle;
  JointId end;
};

constexpr std::array kLegs{Limb{JointId::HipLeft, JointId::KneeLeft, JointId::AnkleLeft},
                           Limb{JointId::HipRight, JointId::KneeRight, JointId::AnkleRight}};
constexpr std::array kArms{Limb{JointId::ShoulderLeft, JointId::ElbowLeft, JointId::WristLeft},
                           Limb{JointId::ShoulderRight, JointId::ElbowRight, JointId::WristRight}};

/// Where the left and the front are, if the held sides are right.
struct Stance {
  Eigen::Vector3d left;
  Eigen::Vector3d forward;  ///< Horizontal.
  double upright = 1.0;
};

/// Weighted mean of how far limbs are bent about an axis [m].
struct Bend {
  double sum = 0.0;
  double weight = 0.0;

  [[nodiscard]] double mean() const { return weight > 0 ? sum / weight : 0.0; }
};

/// How a limb is bent: how far its middle is off the line between its ends [m], and the cosine
/// between `left` and the axis about which its end is bent; zero if it is straight.
struct Hinge {
  double off = 0.0;
  double cosine = 0.0;
};

Hinge hinge_of(const Skeleton<WorldSpace>& body, const Limb& limb, const Eigen::Vector3d& left) {
  const Eigen::Vector3d& root = body[limb.root].position;
  const Eigen::Vector3d& middle = body[limb.middle].position;
  const Eigen::Vector3d& end = body[limb.end].position;
  const Eigen::Vector3d axis = (middle - root).cross(end - middle);
  if (!(axis.norm() > 0)) return {};
  return {off_line(middle, root, end).norm(), axis.normalized().dot(left)};
}

void add_knees(Bend& bend, const Skeleton<WorldSpace>& body, const Eigen::Vector3d& left) {
  for (const Limb& limb : kLegs) {
    const double weight = weight_of(body, limb.root, limb.middle, limb.end);
    const Hinge hinge = hinge_of(body, limb, left);
    bend.sum += weight * hinge.off * hinge.cosine;
    bend.weight += weight;
  }
}

/// Of upright people, the elbows are behind the line from shoulder to wrist.  Of others, elbows are
/// hinges as knees are; but the upper arm rolls by more than a right angle and takes the axis of
/// the elbow with it, so that only an axis well along the left or right shows a side.
void add_elbows(Bend& bend, const Skeleton<WorldSpace>& body, const Stance& stance) {
  for (const Limb& limb : kArms) {
    const double weight = weight_of(body, limb.root, limb.middle, limb.end);
    const Hinge hinge = hinge_of(body, limb, stance.left);
    const double bent = hinge.off * hinge.cosine * std::abs(hinge.cosine);
    const double ahead =
        off_line(body[limb.middle].position, body[limb.root].position, body[limb.end].position)
            .dot(stance.forward);
    bend.sum += weight * (stance.upright * ahead + (1.0 - stance.upright) * bent);
    bend.weight += weight;
  }
}

/// Uses both wrists relative to the centre of the shoulders, because one alone would show how the
/// trunk is turned.
void add_wrists(Offset& offset, const Skeleton<WorldSpace>& body) {
  using enum JointId;
  const auto middle = [&](JointId left) {
    return 0.5 * (body[left].position + body[mirror(left)].position);
  };
  offset.add(middle(WristLeft) - middle(ShoulderLeft),
             weight_of(body, WristLeft, WristRight, ShoulderLeft, ShoulderRight));
}

void add_lean(Offset& offset, const Skeleton<WorldSpace>& body) {
  using enum JointId;
  offset.add(body[SpineShoulder].position - body[SpineBase].position,
             weight_of(body, SpineShoulder, SpineBase));
}

/// Horizontal unit vector from the person to the sensor; zero when the trunk is not seen.
Eigen::Vector3d towards_sensor(const SensorView& view) {
  using enum JointId;
  for (const JointId id : {Neck, SpineShoulder, SpineMid, SpineBase}) {
    const Joint& joint = view.skeleton[id];
    if (!joint.seen()) continue;  // Kinect v1 has no neck.
    Eigen::Vector3d way = view.eye - joint.position;
    way.y() = 0;
    return way.normalized();
  }
  return Eigen::Vector3d::Zero();
}

/// How far a foot that points along `ahead` can be trusted, in [0, 1]: not at all within 90 degrees
/// of the way to the sensor, where a tracker that takes the rear for the front has the feet of
/// somebody who turns the back on it; fully from 110 degrees on.
double trust_in_foot(const Eigen::Vector3d& ahead, const Eigen::Vector3d& to_sensor) {
  constexpr double kAll = 0.34;  // Minus the cosine of 110 degrees.
  return std::clamp(-ahead.normalized().dot(to_sensor) / kAll, 0.0, 1.0);
}

void add_feet(Offset& offset, const SensorView& view) {
  using enum JointId;
  const Eigen::Vector3d to_sensor = towards_sensor(view);
  if (to_sensor.isZero()) return;
  for (const auto& [ankle, foot] :
       {std::pair{AnkleLeft, FootLeft}, std::pair{AnkleRight, FootRight}}) {
    const double weight = weight_of(view.skeleton, ankle, foot);
    Eigen::Vector3d ahead = view.skeleton[foot].position - view.skeleton[ankle].position;
    ahead.y() = 0;
    if (weight > 0 && !ahead.isZero()) offset.add(ahead, weight * trust_in_foot(ahead, to_sensor));
  }
}

double tracked_share_of_arms(const Skeleton<WorldSpace>& body) {
  using enum JointId;
  constexpr std::array kArmJoints{ElbowLeft, WristLeft, ElbowRight, WristRight};
  const auto tracked = std::ranges::count_if(
      kArmJoints, [&](JointId id) { return body[id].state == JointState::Tracked; });
  return static_cast<double>(tracked) / static_cast<double>(kArmJoints.size());
}

/// Positive if the sensors on the side of `forward` track a larger share of the arm joints than the
/// other sensors do.
double seen_from(const std::vector<SensorView>& views, const Eigen::Vector3d& forward) {
  double mean = 0.0;
  for (const SensorView& view : views) mean += tracked_share_of_arms(view.skeleton);
  mean /= static_cast<double>(views.size());
  double beyond = 0.0;
  double weight = 0.0;
  for (const SensorView& view : views) {
    const double along = towards_sensor(view).dot(forward);
    beyond += along * (tracked_share_of_arms(view.skeleton) - mean);
    weight += std::abs(along);
  }
  return weight > 0 ? beyond / weight : 0.0;
}

double of(const Cue& cue, double ahead) {
  return cue.log_odds * std::clamp(ahead / cue.at, -1.0, 1.0);
}

}  // namespace

double posture_log_odds(const std::vector<SensorView>& views, const Eigen::Vector3d& left,
                        double upright, const PostureCues& cues) {
  if (views.empty() || left.isZero()) return 0.0;
  const Stance stance{left, left.cross(Eigen::Vector3d::UnitY()).normalized(), upright};
  Bend knees;
  Bend elbows;
  Offset wrists;
  Offset lean;
  Offset feet;
  for (const SensorView& view : views) {
    add_knees(knees, view.skeleton, left);
    add_elbows(elbows, view.skeleton, stance);
    add_wrists(wrists, view.skeleton);
    add_lean(lean, view.skeleton);
    add_feet(feet, view);
  }
  const double of_upright = of(cues.wrists, wrists.along(stance.forward)) +
                            of(cues.lean, lean.along(stance.forward)) +
                            of(cues.hidden, seen_from(views, stance.forward)) +
                            of(cues.feet, std::min(1.0, feet.weight) * feet.along(stance.forward));
  return of(cues.knees, knees.mean()) + of(cues.elbows, elbows.mean()) + upright * of_upright;
}

}  // namespace chorus::facing
