// Bodies with a posture, as shown by sensors with various habits.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/flow/person.h"

namespace chorus::facing {

/// How far joints are in front of those of a body as flat as a plank [m].
struct Posture {
  double knees = 0.0;
  double wrists = 0.0;
  double elbows = 0.0;
  double shoulders = 0.0;  ///< The arms move with the shoulders.
  double feet = 0.0;       ///< Toes in front of the ankles.
};

inline constexpr Posture kPlank{};
inline constexpr Posture kAtWork{.knees = 0.02, .wrists = 0.25, .elbows = -0.02, .shoulders = 0.05};

/// A person at `place` who faces yaw `heading`; at 0 they face +z, with their left at +x.
[[nodiscard]] inline Skeleton<WorldSpace> body_at(const Eigen::Vector3d& place, double heading,
                                                  const Posture& posture = kPlank) {
  using enum JointId;
  Skeleton<WorldSpace> body;
  const auto put = [&](JointId id, double side, double up, double ahead) {
    const Eigen::Vector3d in_body(side, up, ahead);
    body[id].position = place + about_y(heading) * in_body;
    body[id].orientation = about_y(heading);
    body[id].state = JointState::Tracked;
  };
  const auto both = [&](JointId left, double side, double up, double ahead) {
    put(left, side, up, ahead);
    put(mirror(left), -side, up, ahead);
  };
  const double chest = posture.shoulders;
  put(SpineBase, 0, 1.0, 0);
  put(SpineMid, 0, 1.25, 0.5 * chest);
  put(SpineShoulder, 0, 1.45, chest);
  put(Neck, 0, 1.5, chest);
  put(Head, 0, 1.65, chest);
  both(ShoulderLeft, 0.18, 1.42, chest);
  both(ElbowLeft, 0.22, 1.15, chest + 0.5 * posture.wrists + posture.elbows);
  both(WristLeft, 0.22, 0.90, chest + posture.wrists);
  both(HandLeft, 0.22, 0.82, chest + posture.wrists);
  both(HandTipLeft, 0.22, 0.75, chest + posture.wrists);
  both(ThumbLeft, 0.20, 0.80, chest + posture.wrists);
  both(HipLeft, 0.10, 0.95, 0);
  both(KneeLeft, 0.10, 0.50, posture.knees);
  both(AnkleLeft, 0.10, 0.08, 0);
  both(FootLeft, 0.10, 0.03, posture.feet);
  return body;
}

[[nodiscard]] inline Skeleton<WorldSpace> exchanged(Skeleton<WorldSpace> body) {
  for (const auto& [left, right] : kMirrorPairs) std::swap(body[left], body[right]);
  return body;
}

/// The body turned about a point in the height of the hips.
[[nodiscard]] inline Skeleton<WorldSpace> turned(Skeleton<WorldSpace> body,
                                                 const Eigen::Matrix3d& turn) {
  const Eigen::Vector3d centre = body[JointId::SpineBase].position;
  for (Joint& joint : body.joints) joint.position = centre + turn * (joint.position - centre);
  return body;
}

/// The body as seen by sensor `number`, 3 m from the origin in the direction of yaw `from`.
[[nodiscard]] inline SensorView view_from(int number, double from,
                                          const Skeleton<WorldSpace>& body) {
  SensorView view;
  view.sensor = SensorId::parse("s" + std::to_string(number)).value();
  view.eye = 3.0 * Eigen::Vector3d(std::sin(from), 0.5, std::cos(from));
  view.skeleton = body;
  return view;
}

/// True if the view's left shoulder is the person's left one.
[[nodiscard]] inline bool is_right(const SensorView& view, const Skeleton<WorldSpace>& exact) {
  const auto& shown = view.skeleton[JointId::ShoulderLeft].position;
  return (shown - exact[JointId::ShoulderLeft].position).norm() < 0.1;
}

/// The angles at which a tracker swaps left and right of a person turning away, and swaps them back
/// [rad].
struct Flips {
  double out = deg(130);
  double back = deg(100);
};

inline constexpr Flips kNever{deg(181), deg(181)};

/// Sensors around the origin, each with its habit, that see one person.
class Ring {
 public:
  Ring(std::vector<double> directions, std::vector<Flips> flips)
      : directions_(std::move(directions)),
        flips_(std::move(flips)),
        rear_(directions_.size(), false) {}

  /// Views of a body at the origin that faces `heading`.  Whether a sensor swaps sides depends on
  /// what it saw in earlier calls, too.
  [[nodiscard]] Person look(const Skeleton<WorldSpace>& exact, double heading) {
    Person person{PersonId{1}, {}};
    for (std::size_t s = 0; s < directions_.size(); ++s) {
      const double facing = std::abs(wrap_angle(heading - directions_[s]));
      const Flips& flips = flips_[s % flips_.size()];
      rear_[s] = facing > (rear_[s] ? flips.back : flips.out);
      person.views.push_back(
          view_from(static_cast<int>(s), directions_[s], rear_[s] ? exchanged(exact) : exact));
    }
    return person;
  }

 private:
  std::vector<double> directions_;
  std::vector<Flips> flips_;
  std::vector<bool> rear_;
};

inline const std::vector<double> kSix{deg(0), deg(60), deg(120), deg(180), deg(240), deg(300)};

}  // namespace chorus::facing
