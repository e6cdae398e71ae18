#include "tests/bench/inertial/simulated_take.h"

#include <array>
#include <cmath>

#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"
#include "common/synthetic/coloured_noise.h"
#include "common/synthetic/exercise.h"
#include "common/synthetic/suit_errors.h"

namespace chorus::bench {
namespace {

using synthetic::ColouredNoise;
using synthetic::Draw;

constexpr double kTrackerTau = 0.3;  // of a tracker's error [s]
constexpr double kSimulatedGravity = 9.80665;

/// Noise about three axes, alike for kTrackerTau.
class TrackerNoise {
 public:
  TrackerNoise(std::uint64_t seed, inertial::Limb limb, std::uint64_t purpose)
      : x_(key(seed, limb, purpose, 0), kTrackerTau),
        y_(key(seed, limb, purpose, 1), kTrackerTau),
        z_(key(seed, limb, purpose, 2), kTrackerTau) {}
  [[nodiscard]] Eigen::Vector3d at(double time) const {
    return {x_.at(time), y_.at(time), z_.at(time)};
  }

 private:
  static Draw key(std::uint64_t seed, inertial::Limb limb, std::uint64_t purpose,
                  std::uint64_t axis) {
    return Draw{seed, 900 + purpose, inertial::index_of(limb), axis};
  }
  ColouredNoise x_, y_, z_;
};

synthetic::SimulatedSuit suit_worn_in(const SimulatedTakePlan& plan, Timestamp start) {
  constexpr std::array kPaths{synthetic::PathKind::Random, synthetic::PathKind::Assembly,
                              synthetic::PathKind::Turn, synthetic::PathKind::Circle};
  synthetic::WalkerScript script;
  script.seed = plan.seed;
  script.path = kPaths[plan.seed % kPaths.size()];
  script.body_scale = plan.body_scale;
  synthetic::SimulatedSuit suit;
  suit.scene.epoch = start;
  suit.scene.people = {synthetic::exercising(synthetic::make_people(script, 1).front())};
  suit.limbs = synthetic::limbs_of_suit(plan.sensors);
  suit.seed = plan.seed;
  suit.errors.skin = 1.0;
  suit.errors.magnetometer = true;
  suit.raw = true;
  return suit;
}

double measured_acceleration(const inertial::InertialReading& reading,
                             const Eigen::Quaterniond& inertial_from_sensor) {
  if (!reading.acceleration) return 0.0;
  return (inertial_from_sensor * *reading.acceleration - Eigen::Vector3d(0, kSimulatedGravity, 0))
      .norm();
}

void add_instant(const SimulatedTakePlan& plan, const synthetic::SimulatedSuit& suit, double time,
                 const Skeleton<WorldSpace>& body, const inertial::InertialReading& reading,
                 SimulatedLimb& out) {
  auto limb = synthetic::true_limb(body, out.limb);
  if (!limb || !reading.inertial_from_sensor) return;
  // The tracker states the hand, too, and is read where the sensor sits (evaluation/pronation.h).
  *limb = *limb * about_y(synthetic::pronation(suit, out.limb, time));
  const TrackerNoise turned(plan.seed, out.limb, 0), moved(plan.seed, out.limb, 1);
  evaluation::OrientationPair pair;
  pair.time = time;
  pair.tracked.world_from_limb = *limb * exp_map(kTrackerSigma * turned.at(time));
  pair.inertial_from_sensor = *reading.inertial_from_sensor;
  out.pairs.push_back(pair);
  out.truth.push_back(*limb);
  const Joint& end = body[evaluation::end_joint_of(out.limb)];
  out.true_places.push_back(end.position);
  out.places.push_back({time, end.position + kTrackerJointSigma * moved.at(time)});
  out.acceleration.push_back({time, measured_acceleration(reading, pair.inertial_from_sensor)});
}

/// About the length of the bone that ends at the limb's end [m].
double bone_length(inertial::Limb limb) {
  switch (group_of(limb)) {
    case inertial::LimbGroup::Legs:
      return limb == inertial::Limb::FootLeft || limb == inertial::Limb::FootRight ? 0.2 : 0.42;
    case inertial::LimbGroup::Arms:
      return limb == inertial::Limb::HandLeft || limb == inertial::Limb::HandRight ? 0.09 : 0.27;
    default:
      return 0.25;
  }
}

}  // namespace

std::vector<SimulatedLimb> simulated_take(const SimulatedTakePlan& plan) {
  const Timestamp start{std::chrono::seconds(1000)};
  const synthetic::SimulatedSuit suit = suit_worn_in(plan, start);
  std::vector<SimulatedLimb> out;
  for (const inertial::Limb limb : suit.limbs) {
    out.emplace_back().limb = limb;
    out.back().length = bone_length(limb);
  }
  const int instants = static_cast<int>(plan.length * plan.rate_hz);
  for (int i = 0; i < instants; ++i) {
    const double time = i / plan.rate_hz;
    const Timestamp at = start + from_seconds(time);
    const auto frame = synthetic::suit_at(suit, start, at, static_cast<std::uint64_t>(i) + 1);
    const auto body = synthetic::truth(suit.scene, 0, at);
    for (std::size_t s = 0; s < std::min(out.size(), frame.readings.size()); ++s)
      add_instant(plan, suit, time, body, frame.readings[s], out[s]);
  }
  return out;
}

}  // namespace chorus::bench
