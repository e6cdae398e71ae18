#include "services/sensor/device/glove/hand_frames.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "common/sensor/pixel_ray.h"

namespace chorus::glove {
namespace {

using hand::hand_joint;

// Of a finger's tip against the wrist: five degrees over a finger's length [m].
constexpr double kFingerSigma = 0.008;

double tenth_mm(double metres) { return std::round(metres * 1e4) / 1e4; }

}  // namespace

SeenJoints joints_in_sensor(const hand::Skeleton& skeleton, const PlacedHand& placed) {
  const Eigen::Matrix3d axes = camera_from_sensor_axes().transpose();
  SeenJoints out;
  out.side = skeleton.side;
  out.joints = hand::joints_of(skeleton, placed.pose);
  for (Eigen::Vector3d& joint : out.joints) joint = axes * joint;
  out.covariance = axes * placed.place.covariance * axes.transpose();
  return out;
}

BodyFrame body_of(const SeenJoints& hand, Timestamp captured) {
  const bool left = hand.side == hand::Side::Left;
  BodyFrame out{BodyId{1}, captured, {}};
  const auto put = [&](JointId id, const Eigen::Vector3d& at, double sigma) {
    Joint& joint = out.skeleton[id];
    joint.position = at;
    joint.state = JointState::Tracked;
    joint.covariance =
        Covariance(Eigen::Matrix3d(hand.covariance + sigma * sigma * Eigen::Matrix3d::Identity()));
  };
  const auto& at = hand.joints;
  put(left ? JointId::WristLeft : JointId::WristRight, at[0], 0.0);
  put(left ? JointId::HandLeft : JointId::HandRight, 0.5 * (at[0] + at[hand_joint(2, 0)]), 0.0);
  put(left ? JointId::HandTipLeft : JointId::HandTipRight, at[hand_joint(2, 3)], kFingerSigma);
  put(left ? JointId::ThumbLeft : JointId::ThumbRight, at[hand_joint(0, 3)], kFingerSigma);
  Hands hands;
  (left ? hands.left : hands.right) = HandPoints{at, hand.covariance.trace() / 3.0};
  out.hands = shared(std::move(hands));
  return out;
}

std::string hands_json(const SensorId& sensor, Timestamp captured, const SeenJoints* hand) {
  using nlohmann::json;
  json out{{"sensor", sensor.str()},
           {"captured", to_iso8601(captured)},
           {"space", "SensorSpace"},
           {"hands", json::array()}};
  if (hand == nullptr) return out.dump() + "\n";
  json joints = json::array();
  for (const Eigen::Vector3d& p : hand->joints)
    joints.push_back({tenth_mm(p.x()), tenth_mm(p.y()), tenth_mm(p.z())});
  const Eigen::Matrix3d& c = hand->covariance;
  out["hands"].push_back({{"bodyId", 1},
                          {"side", name_of(hand->side)},
                          {"layout", layout::kHandLayout},
                          {"joints", std::move(joints)},
                          {"covariance", {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}}});
  return out.dump() + "\n";
}

}  // namespace chorus::glove
