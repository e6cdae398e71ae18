#include "common/synthetic/simulated_suit.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <string>

#include "common/geometry/rotation.h"
#include "common/synthetic/suit_errors.h"

namespace chorus::synthetic {
namespace {

using inertial::InertialReading;
using inertial::Limb;
using inertial::MagneticState;

/// What a draw is for.
enum SuitPurpose : std::uint64_t {
  kMountDraw = 331,
  kHeadingDraw,
  kNoiseDraw,
  kRateDraw,
  kForceDraw
};

constexpr double kStandardGravity = 9.80665;  // [m/s^2]
constexpr double kSilent = 1e-4;              // a disturbance below this is none [rad]
constexpr double kRateNoise = deg(0.1);       // of a chip, per sample [rad/s]
constexpr double kForceNoise = 0.02;          // of a chip, per sample [m/s^2]
constexpr Duration kApart = std::chrono::milliseconds(10);  // of the poses that give derivatives

// The joint whose orientation is that of the limb's bone, the one at its outer end; and where a
// scene gives that no orientation: the head turns with the chest, a hand with the forearm, a foot
// with the shank.
struct LimbJoints {
  JointId outer, inner;
};
using enum JointId;
// clang-format off
constexpr std::array<LimbJoints, inertial::kLimbCount> kJoints{{
  {SpineBase, SpineBase}, {SpineShoulder, SpineShoulder}, {Head, SpineShoulder},
  {ElbowLeft, ElbowLeft}, {WristLeft, WristLeft}, {HandLeft, WristLeft},
  {ElbowRight, ElbowRight}, {WristRight, WristRight}, {HandRight, WristRight},
  {KneeLeft, KneeLeft}, {AnkleLeft, AnkleLeft}, {FootLeft, AnkleLeft},
  {KneeRight, KneeRight}, {AnkleRight, AnkleRight}, {FootRight, AnkleRight}}};
// clang-format on

Draw draw_for(const SimulatedSuit& suit, SuitPurpose purpose, Limb limb, std::uint64_t number = 0) {
  return Draw{suit.seed, purpose, inertial::index_of(limb), number};
}

/// A mount of any direction: uniform on the rotations.
Eigen::Quaterniond mount_of(const SimulatedSuit& suit, Limb limb) {
  Draw draw = draw_for(suit, kMountDraw, limb);
  Eigen::Quaterniond mount(draw.gauss(), draw.gauss(), draw.gauss(), draw.gauss());
  return normalised_or_identity(mount);
}

double heading_of(const SimulatedSuit& suit, Limb limb) {
  return draw_for(suit, kHeadingDraw, limb).uniform(-std::numbers::pi, std::numbers::pi);
}

/// world_from_sensor, but for the sensor's own noise and heading.
std::optional<Eigen::Quaterniond> carried(const SimulatedSuit& suit, Limb limb,
                                          const Skeleton<WorldSpace>& body, double since) {
  const auto bone = true_limb(body, limb);
  if (!bone) return std::nullopt;
  return *bone * about_y(pronation(suit, limb, since)) * skin_error(suit, limb, since) *
         slip_error(suit, limb, since) * mount_of(suit, limb);
}

/// The poses around an instant, from which derivatives are taken.
struct Moment {
  std::array<Skeleton<WorldSpace>, 3> bodies;  ///< kApart before, at, and after the instant.
  double since = 0.0;
};

/// What the chips of the sensor measure.
void add_raw(const SimulatedSuit& suit, Limb limb, const Moment& moment, std::uint64_t number,
             InertialReading& out) {
  const double step = seconds(kApart);
  const auto before = carried(suit, limb, moment.bodies[0], moment.since - step);
  const auto now = carried(suit, limb, moment.bodies[1], moment.since);
  const auto after = carried(suit, limb, moment.bodies[2], moment.since + step);
  if (!before || !now || !after) return;
  const JointId joint = kJoints[inertial::index_of(limb)].outer;
  const auto place = [&](std::size_t i) { return moment.bodies[i][joint].position; };
  const Eigen::Vector3d acceleration = (place(2) - 2.0 * place(1) + place(0)) / (step * step);
  const Eigen::Vector3d force = acceleration + Eigen::Vector3d(0.0, kStandardGravity, 0.0);
  out.rate = log_map(before->conjugate() * *after) / (2.0 * step) +
             kRateNoise * draw_for(suit, kRateDraw, limb, number).gauss3();
  out.acceleration =
      now->conjugate() * force + kForceNoise * draw_for(suit, kForceDraw, limb, number).gauss3();
}

MagneticState field_at(const SimulatedSuit& suit, Limb limb, double since) {
  if (!suit.errors.magnetometer) return MagneticState::None;
  return std::abs(disturbance(suit, limb, since)) > kSilent ? MagneticState::Disturbed
                                                            : MagneticState::Undisturbed;
}

std::optional<InertialReading> reading_of(const SimulatedSuit& suit, Limb named,
                                          const Moment& moment, std::uint64_t number) {
  const auto charge = charge_left(suit, named, moment.since);
  if (!charge) return std::nullopt;
  const Limb limb = felt_limb(suit, named, moment.since);
  InertialReading out;
  out.sensor = suit_sensor_name(named);
  out.magnetic = field_at(suit, limb, moment.since);
  out.battery = *charge;
  const auto sensor = carried(suit, limb, moment.bodies[1], moment.since);
  if (!sensor) return out;  // The scene does not say.
  const double heading = heading_error(suit, limb, moment.since) - heading_of(suit, limb);
  const Eigen::Vector3d noise =
      suit.errors.noise * draw_for(suit, kNoiseDraw, limb, number).gauss3();
  out.inertial_from_sensor = (about_y(heading) * *sensor * exp_map(noise)).normalized();
  const double stated = suit.errors.noise * stated_share(suit, named, moment.since);
  out.covariance = Eigen::Matrix3d::Identity() * (stated * stated);
  if (suit.raw) add_raw(suit, limb, moment, number, out);
  return out;
}

}  // namespace

std::vector<Limb> limbs_of_suit(int sensors) {
  using enum Limb;
  if (sensors <= 5) return {Chest, HandLeft, HandRight, ShankLeft, ShankRight};
  std::vector<Limb> limbs{Pelvis, Chest, ForearmLeft, ForearmRight, ShankLeft, ShankRight};
  if (sensors <= static_cast<int>(limbs.size())) return limbs;
  for (const Limb limb : {Limb::Head, UpperArmLeft, UpperArmRight, ThighLeft, ThighRight,
                          Limb::FootLeft, Limb::FootRight})
    limbs.push_back(limb);
  return limbs;
}

std::string suit_sensor_name(Limb limb) { return "tracker-" + std::string(name_of(limb)); }

std::optional<Eigen::Quaterniond> true_limb(const Skeleton<WorldSpace>& body, Limb limb) {
  const LimbJoints& joints = kJoints[inertial::index_of(limb)];
  for (const JointId joint : {joints.outer, joints.inner})
    if (is_unit(body[joint].orientation)) return body[joint].orientation.normalized();
  return std::nullopt;
}

inertial::InertialCalibration true_calibration(const SimulatedSuit& suit, const SensorId& source) {
  inertial::InertialCalibration calibration{source.str(), suit.scene.epoch, {}};
  for (const Limb limb : suit.limbs) {
    inertial::SensorCalibration& one = calibration.sensors.emplace_back();
    one.sensor = suit_sensor_name(limb);
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
  Moment moment;
  moment.since = seconds(instant - start);
  moment.bodies[1] = truth(suit.scene, suit.person, instant);
  if (suit.raw) {
    moment.bodies[0] = truth(suit.scene, suit.person, instant - kApart);
    moment.bodies[2] = truth(suit.scene, suit.person, instant + kApart);
  }
  for (const Limb limb : suit.limbs) {
    auto reading = reading_of(suit, limb, moment, number);
    if (!reading) continue;
    reading->captured = instant;
    frame.readings.push_back(std::move(*reading));
  }
  return frame;
}

}  // namespace chorus::synthetic
