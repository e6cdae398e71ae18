// A standing person and four sensors around them, for tests of the body filter.
#pragma once

#include <utility>
#include <vector>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/fuse.h"
#include "tests/unit/fusion/views.h"

namespace chorus::fusion::body_room {

using std::chrono::milliseconds;
using enum JointId;

inline const std::vector<SensorId> kSensors{sensor(1), sensor(2), sensor(3), sensor(4)};
inline constexpr Timestamp kStart = from_unix_ns(1'795'246'200'000'000'000);
inline constexpr int kFilterSteps = 90;

/// A standing body with arms stretched out, facing +z.
inline Skeleton<WorldSpace> standing() {
  Skeleton<WorldSpace> body;
  const auto put = [&](JointId joint, double x, double y) {
    body[joint].position = Eigen::Vector3d(x, y, 0.02 * y);
    body[joint].state = JointState::Tracked;
  };
  put(SpineBase, 0, 0.95);
  put(SpineMid, 0, 1.2);
  put(SpineShoulder, 0, 1.4);
  put(Neck, 0, 1.47);
  put(Head, 0, 1.65);
  for (const double side : {1.0, -1.0}) {
    const auto of = [side](JointId left) { return side > 0 ? left : mirror(left); };
    put(of(ShoulderLeft), 0.18 * side, 1.38);
    put(of(ElbowLeft), 0.45 * side, 1.35);
    put(of(WristLeft), 0.7 * side, 1.33);
    put(of(HipLeft), 0.09 * side, 0.92);
    put(of(KneeLeft), 0.1 * side, 0.5);
    put(of(AnkleLeft), 0.1 * side, 0.09);
  }
  return body;
}

/// The body as seen by one of four sensors around it, 3 m away; sensor 1 is in front of it.
inline SensorView view_of(int number, const Skeleton<WorldSpace>& body) {
  SensorView view;
  view.sensor = sensor(number);
  view.weight = 0.5;
  view.eye = about_y(deg(90) * (number - 1)) * Eigen::Vector3d(0, 1.6, 3);
  view.skeleton = body;
  return view;
}

inline Skeleton<WorldSpace> scaled(Skeleton<WorldSpace> body, double by) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const JointId id : kCoreJoints) middle += body[id].position / 5.0;
  for (Joint& joint : body.joints) joint.position = middle + by * (joint.position - middle);
  return body;
}

/// Limbs rotated about the spine, as by a sensor that sees the body from the side.
inline Skeleton<WorldSpace> turned(Skeleton<WorldSpace> body, double by) {
  for (Joint& joint : body.joints) {
    if (std::abs(joint.position.x()) > 0) joint.position = about_y(by) * joint.position;
  }
  return body;
}

struct Room {
  Room() { config.method = Method::BodyFilter; }

  FusedBody at(int step, std::vector<SensorView> views) {
    return memory.fuse({{PersonId{1}, std::move(views)}},
                       {kStart + milliseconds(33) * step, kSensors}, config)[0];
  }
  /// All four sensors see the same body.
  FusedBody all_see(int step, const Skeleton<WorldSpace>& body) {
    return at(step, {view_of(1, body), view_of(2, body), view_of(3, body), view_of(4, body)});
  }
  FusedBody settled(const Skeleton<WorldSpace>& body) {
    for (int i = 0; i < kFilterSteps; ++i) (void)all_see(i, body);
    return all_see(kFilterSteps, body);
  }

  FusionConfig config;
  Memory memory;
};

inline double wrist_off(const FusedBody& body, const Skeleton<WorldSpace>& exact) {
  return (body.skeleton[WristLeft].position - exact[WristLeft].position).norm();
}

}  // namespace chorus::fusion::body_room
