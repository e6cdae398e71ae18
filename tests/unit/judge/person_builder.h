// Small hand-made people and reported bodies for the tests of baselines and metrics.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "common/body/bones.h"
#include "fusion-server/flow/person.h"
#include "tests/judge/metrics.h"

namespace chorus::bench {

inline SensorId sensor(int number) { return SensorId::parse("s" + std::to_string(number)).value(); }

inline Timestamp at_frame(int number) {
  return from_unix_ns(1'000'000'000) + number * std::chrono::milliseconds(40);
}

inline Joint tracked(const Eigen::Vector3d& position) {
  Joint joint;
  joint.position = position;
  joint.state = JointState::Tracked;
  return joint;
}

inline Joint inferred(const Eigen::Vector3d& position) {
  Joint joint = tracked(position);
  joint.state = JointState::Inferred;
  return joint;
}

/// A view that tracks `count` joints from SpineBase on, all at `place`; its body is turned by
/// `facing` from facing the sensor.
inline SensorView view_of(int number, std::size_t count, double facing,
                          const Eigen::Vector3d& place = Eigen::Vector3d::Zero()) {
  SensorView view;
  view.sensor = sensor(number);
  view.facing = facing;
  for (std::size_t i = 0; i < count; ++i) view.skeleton.joints[i] = tracked(place);
  return view;
}

/// A person who stands at `place`, facing +z with left at +x; every joint has another height.
inline Skeleton<WorldSpace> standing(const Eigen::Vector3d& place) {
  Skeleton<WorldSpace> body;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    body.joints[i] = tracked(place + Eigen::Vector3d(0, 0.1 * static_cast<double>(i), 0));
  }
  for (const auto& [left, right] : kMirrorPairs) {
    body[right] = body[left];
    body[left].position.x() += 0.2;
    body[right].position.x() -= 0.2;
  }
  return body;
}

/// `count` instants of a person who walks along +x at `speed` [m/s] and is reported exactly.
inline Answers exact_walk(int count, double speed) {
  Answers answers;
  for (int i = 0; i < count; ++i) {
    const auto body = standing({speed * 0.04 * i, 0, 0});
    answers.push_back({at_frame(i), body, body});
  }
  return answers;
}

}  // namespace chorus::bench
