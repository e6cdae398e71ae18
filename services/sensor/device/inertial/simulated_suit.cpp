#include "services/sensor/device/inertial/simulated_suit.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/geometry/rotation.h"
#include "common/synthetic/draw.h"

namespace chorus::inertial_device {
namespace {

using inertial::Limb;
using synthetic::Draw;

/// What a draw is for.
enum Purpose : std::uint64_t { kMountDraw = 301, kHeadingDraw, kDriftDraw, kNoiseDraw };

/// The joint whose orientation is that of the limb's bone: the one at its outer end.
JointId outer_joint(Limb limb) {
  static constexpr std::array<JointId, inertial::kLimbCount> kJoints{
      JointId::SpineBase, JointId::SpineShoulder, JointId::Head,       JointId::ElbowLeft,
      JointId::WristLeft, JointId::HandLeft,      JointId::ElbowRight, JointId::WristRight,
      JointId::HandRight, JointId::KneeLeft,      JointId::AnkleLeft,  JointId::FootLeft,
      JointId::KneeRight, JointId::AnkleRight,    JointId::FootRight};
  return kJoints[inertial::index_of(limb)];
}

/// Where a scene gives the outer joint no orientation: the head turns with the chest, a hand with
/// the forearm, a foot with the shank.
JointId inner_joint(Limb limb) {
  switch (limb) {
    case Limb::Head:
      return JointId::SpineShoulder;
    case Limb::HandLeft:
      return JointId::WristLeft;
    case Limb::HandRight:
      return JointId::WristRight;
    case Limb::FootLeft:
      return JointId::AnkleLeft;
    case Limb::FootRight:
      return JointId::AnkleRight;
    default:
      return outer_joint(limb);
  }
}

bool is_unit(const Eigen::Quaterniond& q) { return std::abs(q.norm() - 1.0) < 1e-3; }

Draw draw_for(const SimulatedSuit& suit, Purpose purpose, Limb limb, std::uint64_t number = 0) {
  return Draw{suit.seed, purpose, inertial::index_of(limb), number};
}

/// A mount of any direction: uniform on the rotations.
Eigen::Quaterniond mount_of(const SimulatedSuit& suit, Limb limb) {
  Draw draw = draw_for(suit, kMountDraw, limb);
  Eigen::Quaterniond mount(draw.gauss(), draw.gauss(), draw.gauss(), draw.gauss());
  return mount.norm() > 1e-9 ? mount.normalized() : Eigen::Quaterniond::Identity();
}

double heading_of(const SimulatedSuit& suit, Limb limb) {
  return draw_for(suit, kHeadingDraw, limb).uniform(-std::numbers::pi, std::numbers::pi);
}

std::string sensor_of(Limb limb) { return "tracker-" + std::string(name_of(limb)); }

/// The slip as a rotation about the limb's own axis, at a time after the start.
Eigen::Quaterniond slip_of(const SimulatedSuit& suit, Limb limb, Duration since) {
  if (suit.slips != limb || since < suit.slips_after) return Eigen::Quaterniond::Identity();
  return exp_map(Eigen::Vector3d(0.0, suit.slips_by, 0.0));
}

}  // namespace

std::vector<Limb> limbs_of_suit(int sensors) {
  std::vector<Limb> limbs{Limb::Pelvis,       Limb::Chest,     Limb::ForearmLeft,
                          Limb::ForearmRight, Limb::ShankLeft, Limb::ShankRight};
  if (sensors <= static_cast<int>(limbs.size())) return limbs;
  for (const Limb limb : {Limb::Head, Limb::UpperArmLeft, Limb::UpperArmRight, Limb::ThighLeft,
                          Limb::ThighRight, Limb::FootLeft, Limb::FootRight})
    limbs.push_back(limb);
  return limbs;
}

inertial::InertialCalibration true_calibration(const SimulatedSuit& suit, const SensorId& source) {
  inertial::InertialCalibration calibration{source.str(), suit.scene.epoch, {}};
  for (const Limb limb : suit.limbs) {
    inertial::SensorCalibration& one = calibration.sensors.emplace_back();
    one.sensor = sensor_of(limb);
    one.limb = limb;
    one.heading = heading_of(suit, limb);
    one.limb_from_sensor = mount_of(suit, limb);
  }
  return calibration;
}

inertial::InertialFrame suit_at(const SimulatedSuit& suit, Timestamp start, Timestamp instant,
                                std::uint64_t number) {
  inertial::InertialFrame frame;
  frame.sequence = number;
  frame.captured = instant;
  const Skeleton<WorldSpace> person = synthetic::truth(suit.scene, suit.person, instant);
  const double since = seconds(instant - start);
  for (const Limb limb : suit.limbs) {
    inertial::InertialReading& one = frame.readings.emplace_back();
    one.sensor = sensor_of(limb);
    one.captured = instant;
    one.magnetic = inertial::MagneticState::None;
    const Eigen::Quaterniond& outer = person[outer_joint(limb)].orientation;
    const Eigen::Quaterniond& world_from_limb =
        is_unit(outer) ? outer : person[inner_joint(limb)].orientation;
    if (!is_unit(world_from_limb)) continue;  // The scene does not say.
    const double drift =
        suit.heading_drift * draw_for(suit, kDriftDraw, limb).uniform(-1.0, 1.0) * since;
    const Eigen::Vector3d noise = suit.noise * draw_for(suit, kNoiseDraw, limb, number).gauss3();
    one.inertial_from_sensor =
        (about_y(drift - heading_of(suit, limb)) * world_from_limb *
         slip_of(suit, limb, instant - start) * mount_of(suit, limb) * exp_map(noise))
            .normalized();
    one.covariance = Eigen::Matrix3d::Identity() * (suit.noise * suit.noise);
  }
  return frame;
}

}  // namespace chorus::inertial_device
