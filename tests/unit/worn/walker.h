// People who move, as fusion gives them, and the sensors that one of them wears.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"
#include "common/inertial/inertial_frame.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::worn::walker {

using enum JointId;
using inertial::Limb;

inline constexpr Timestamp kBegin = from_unix_ns(1'795'246'200'000'000'000);
inline constexpr std::array kLimbs{Limb::UpperArmLeft, Limb::ForearmLeft, Limb::ThighLeft,
                                   Limb::ShankLeft,    Limb::ThighRight,  Limb::ShankRight};

inline Timestamp at(double time) { return kBegin + from_seconds(time); }

/// How somebody moves; `lively` 0: not at all.
struct Walker {
  std::uint64_t id = 1;
  double phase = 0.0;
  double tempo = 1.0;
  double lively = 1.0;
  double x = 0.0;
};

/// A limb of this length that hangs from `from`, swung ahead and to the side.
inline Eigen::Vector3d hung(const Eigen::Vector3d& from, double length, double ahead,
                            double aside) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(aside, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(-ahead, Eigen::Vector3d::UnitX()));
  return from + turn * Eigen::Vector3d(0, -length, 0);
}

inline Skeleton<WorldSpace> body_of(const Walker& who, double time) {
  const double t = who.lively > 0 ? who.tempo * time + who.phase : who.phase;
  const double much = who.lively;
  Skeleton<WorldSpace> body;
  const auto put = [&](JointId id, const Eigen::Vector3d& place) {
    body[id].position = place;
    body[id].state = JointState::Tracked;
  };
  put(SpineBase, {0, 0.95, 0});
  put(SpineMid, {0, 1.2, 0.02});
  put(SpineShoulder, {0, 1.4, 0.03});
  for (const double side : {1.0, -1.0}) {
    const auto of = [side](JointId left) { return side > 0 ? left : mirror(left); };
    const double s = std::sin(4.0 * t + (side > 0 ? 0.0 : 3.1));
    const double wide = 0.25 + much * 0.2 * std::sin(1.7 * t);
    put(of(ShoulderLeft), {0.18 * side, 1.38, 0.03});
    put(of(ElbowLeft),
        hung(body[of(ShoulderLeft)].position, 0.28, 0.3 - much * 0.6 * s, side * wide));
    put(of(WristLeft), hung(body[of(ElbowLeft)].position, 0.25, 1.1 - much * 0.7 * s, side * wide));
    put(of(HipLeft), {0.09 * side, 0.92, 0});
    put(of(KneeLeft),
        hung(body[of(HipLeft)].position, 0.42, 0.4 + much * 0.5 * s, 0.4 * side * wide));
    put(of(AnkleLeft),
        hung(body[of(KneeLeft)].position, 0.4, -0.4 + much * 0.4 * s, 0.4 * side * wide));
  }
  const Eigen::Quaterniond yaw = about_y(much * 1.2 * std::sin(0.5 * t) + who.phase);
  for (Joint& joint : body.joints)
    if (joint.seen()) joint.position = yaw * joint.position + Eigen::Vector3d(who.x, 0, 0);
  return body;
}

/// As fusion gives it, with errors of this size [m].
inline FusedBody fused_of(const Walker& who, double time, double noise, std::mt19937_64& random) {
  std::normal_distribution<double> gauss(0.0, noise);
  FusedBody body;
  body.id = PersonId{who.id};
  body.skeleton = body_of(who, time);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    Joint& joint = body.skeleton.joints[j];
    if (!joint.seen()) continue;
    for (int k = 0; k < 3; ++k) joint.position[k] += noise > 0 ? gauss(random) : 0.0;
    joint.covariance = Covariance(Eigen::Matrix3d(4e-4 * Eigen::Matrix3d::Identity()));
    body.variance[j] = 4e-4;
    body.contributors[j] = 1;
  }
  return body;
}

/// Sensors on kLimbs of a person, each with a mount and a heading of its own.
struct Suit {
  SensorId id = *SensorId::parse("suit");
  double drift = 0.0;                  ///< Of every heading [rad/s].
  std::map<Limb, double> slip = {};    ///< By which a sensor is turned about its limb's +x [rad].
  std::map<Limb, double> states = {};  ///< Its own error [rad]; negative: it says nothing at all.

  [[nodiscard]] inertial::InertialFrame says(const Walker& wearer, double time) const {
    inertial::InertialFrame frame{id, 0, at(time), at(time), {}};
    for (std::size_t i = 0; i < kLimbs.size(); ++i) {
      const auto tracked = evaluation::limb_from_joints(body_of(wearer, time), kLimbs[i]);
      const double n = static_cast<double>(i);
      const Eigen::Quaterniond mount = exp_map(Eigen::Vector3d(0.4 - 0.3 * n, 0.2 * n, -0.5 + n));
      const Eigen::Quaterniond heading = about_y(-(0.6 - 0.5 * n + drift * time));
      const auto slipped = slip.find(kLimbs[i]);
      const Eigen::Quaterniond turn =
          exp_map(Eigen::Vector3d(slipped == slip.end() ? 0.0 : slipped->second, 0, 0));
      inertial::InertialReading reading;
      reading.sensor = std::string(name_of(kLimbs[i]));
      reading.captured = at(time);
      reading.inertial_from_sensor = heading * tracked->world_from_limb * turn * mount;
      const auto stated = states.find(kLimbs[i]);
      if (stated != states.end() && stated->second < 0) continue;
      if (stated != states.end())
        reading.covariance = stated->second * stated->second * Eigen::Matrix3d::Identity();
      frame.readings.push_back(std::move(reading));
    }
    return frame;
  }
};

}  // namespace chorus::worn::walker
