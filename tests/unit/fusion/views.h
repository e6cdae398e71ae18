// Small hand-made views for the fusion tests.
#pragma once

#include <string>

#include "fusion-server/flow/person.h"

namespace chorus::fusion {

inline SensorId sensor(int number) { return SensorId::parse("s" + std::to_string(number)).value(); }

/// A view in which only the neck is seen.
inline SensorView neck_view(int number, const Eigen::Vector3d& neck, double weight,
                            const Eigen::Vector3d& eye = {0, 1, 5}) {
  SensorView view;
  view.sensor = sensor(number);
  view.weight = weight;
  view.eye = eye;
  Joint& joint = view.skeleton[JointId::Neck];
  joint.position = neck;
  joint.orientation = Eigen::Quaterniond::Identity();
  joint.state = JointState::Tracked;
  return view;
}

}  // namespace chorus::fusion
