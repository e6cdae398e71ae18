// Poses for the rig of humanoid outputs, made from the T-pose by hand.
#pragma once

#include <cmath>
#include <vector>

#include "common/base/units.h"
#include "fusion-server/outlet/tracker_frame.h"

namespace chorus::outlet::testing {

/// A person exactly at rest: looks along -z, left hand at -x, pelvis 0.95 m above the floor at x =
/// z = 0. The joints have no orientations.
inline outlet::TrackerBody t_pose() {
  using enum JointId;
  struct Place {
    JointId joint;
    double x, y, z;
  };
  const double falls = 0.14 * std::sin(deg(25));
  const double ahead = 0.14 * std::cos(deg(25));
  const std::vector<Place> left{
      {ShoulderLeft, -0.18, 1.42, 0}, {ElbowLeft, -0.46, 1.42, 0},
      {WristLeft, -0.71, 1.42, 0},    {HandLeft, -0.78, 1.42, 0},
      {HandTipLeft, -0.86, 1.42, 0},  {ThumbLeft, -0.74, 1.42, -0.06},
      {HipLeft, -0.09, 0.91, 0},      {KneeLeft, -0.09, 0.50, 0},
      {AnkleLeft, -0.09, 0.09, 0},    {FootLeft, -0.09, 0.09 - falls, -ahead}};
  const std::vector<Place> right{
      {ShoulderRight, 0.18, 1.42, 0}, {ElbowRight, 0.46, 1.42, 0},
      {WristRight, 0.71, 1.42, 0},    {HandRight, 0.78, 1.42, 0},
      {HandTipRight, 0.86, 1.42, 0},  {ThumbRight, 0.74, 1.42, -0.06},
      {HipRight, 0.09, 0.91, 0},      {KneeRight, 0.09, 0.50, 0},
      {AnkleRight, 0.09, 0.09, 0},    {FootRight, 0.09, 0.09 - falls, -ahead}};
  const std::vector<Place> centre{{SpineBase, 0, 0.95, 0},
                                  {SpineMid, 0, 1.20, 0},
                                  {SpineShoulder, 0, 1.43, 0},
                                  {Neck, 0, 1.50, 0},
                                  {Head, 0, 1.65, 0}};
  outlet::TrackerBody body;
  for (const auto& places : {left, right, centre}) {
    for (const Place& at : places) {
      outlet::TrackerJoint& joint = body.joints[index_of(at.joint)];
      joint.position = {at.x, at.y, at.z};
      joint.tracked = true;
    }
  }
  return body;
}

/// Rotates joints and their orientations about a point.
inline void turn(outlet::TrackerBody& body, const std::vector<JointId>& joints, JointId about,
                 const Eigen::Quaterniond& by) {
  const Eigen::Vector3d centre = body[about].position;
  for (const JointId id : joints) {
    outlet::TrackerJoint& joint = body.joints[index_of(id)];
    joint.position = centre + by * (joint.position - centre);
    joint.orientation = by * joint.orientation;
  }
}

inline const std::vector<JointId> kLeftArm{JointId::ElbowLeft, JointId::WristLeft,
                                           JointId::HandLeft, JointId::HandTipLeft,
                                           JointId::ThumbLeft};
inline const std::vector<JointId> kLeftForearm{JointId::WristLeft, JointId::HandLeft,
                                               JointId::HandTipLeft, JointId::ThumbLeft};
inline const std::vector<JointId> kRightArm{JointId::ElbowRight, JointId::WristRight,
                                            JointId::HandRight, JointId::HandTipRight,
                                            JointId::ThumbRight};

inline Eigen::Quaterniond about(const Eigen::Vector3d& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(deg(degrees), axis));
}
inline Eigen::Quaterniond about_x(double degrees) {
  return about(Eigen::Vector3d::UnitX(), degrees);
}
inline Eigen::Quaterniond about_up(double degrees) {
  return about(Eigen::Vector3d::UnitY(), degrees);
}
inline Eigen::Quaterniond about_z(double degrees) {
  return about(Eigen::Vector3d::UnitZ(), degrees);
}

/// Turns the whole body about the origin by a yaw, and then moves it by `by`.
inline void move(outlet::TrackerBody& body, const Eigen::Vector3d& by, double yaw_degrees) {
  for (outlet::TrackerJoint& joint : body.joints) {
    joint.position = by + about_up(yaw_degrees) * joint.position;
    joint.orientation = about_up(yaw_degrees) * joint.orientation;
  }
}

/// Left arm down with the forearm raised forwards, right arm forwards, left leg forwards, the upper
/// body bent and twisted, the whole body moved: no two axes look alike.
inline outlet::TrackerBody asymmetric_pose() {
  using enum JointId;
  outlet::TrackerBody body = t_pose();
  turn(body, kLeftArm, ShoulderLeft, about_z(80));
  turn(body, kLeftForearm, ElbowLeft, about_x(70));
  turn(body, kRightArm, ShoulderRight, about_up(65));
  turn(body, {KneeLeft, AnkleLeft, FootLeft}, HipLeft, about_x(40));
  std::vector<JointId> upper{SpineMid, SpineShoulder, Neck, Head, ShoulderLeft, ShoulderRight};
  upper.insert(upper.end(), kLeftArm.begin(), kLeftArm.end());
  upper.insert(upper.end(), kRightArm.begin(), kRightArm.end());
  turn(body, upper, SpineBase, about_x(-12) * about_up(20) * about_z(7));
  move(body, {1, 2, 3}, 30);
  return body;
}

}  // namespace chorus::outlet::testing
