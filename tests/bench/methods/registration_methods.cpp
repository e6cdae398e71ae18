#include "tests/bench/methods/registration_methods.h"

#include <algorithm>
#include <limits>

#include "common/geometry/error_radius.h"
#include "tests/bench/methods/pair_estimators.h"
#include "tests/judge/place_error.h"

namespace chorus::bench {
namespace {

using registration::JointChoice;
using registration::PairEstimator;
using registration::PairMethod;
using registration::RegistrationConfig;
using registration::WalkTrack;

constexpr double kLost = 0.1;       // a sensor farther off counts as not registered [m]
constexpr double kChi2Of2 = 5.991;  // 95 % with two degrees of freedom
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
// Factor by which successive pairs, which are correlated, typically increase the variance.
constexpr double kTypicalInflation = 19.0;
const Eigen::Vector3d kCentreInScene(0, 1, 0);

/// A method that differs by its configuration alone.
RegistrationMethod configured(std::string name, RegistrationConfig config) {
  return {std::move(name),
          [config](const std::vector<WalkTrack>& walk, Timestamp now, const SensorId& master) {
            RegistrationConfig own = config;
            own.master = master;
            return solve(walk, now, own);
          }};
}

/// A method with another estimator of pairs.
RegistrationMethod estimated(std::string name, RegistrationConfig config, PairEstimator estimate) {
  return {std::move(name), [config, estimate](const std::vector<WalkTrack>& walk, Timestamp now,
                                              const SensorId& master) {
            RegistrationConfig own = config;
            own.master = master;
            return solve_with(estimate, walk, now, own);
          }};
}

/// Least squares in place of our method's pair stage.
PairEstimator plain_pairs(const RegistrationConfig& config) {
  return [plain = closed_form(config)](const registration::Walker& target,
                                       const registration::Walker& source) {
    auto edge = plain(target, source);
    if (edge) edge->inflation = kTypicalInflation;
    return edge;
  };
}

bool covers(const Extrinsics& place, const Eigen::Isometry3d& exact) {
  const Eigen::Vector3d off = place.world_from_sensor.translation() - exact.translation();
  const auto position = place.covariance.bottomRightCorner<3, 3>();
  Eigen::Matrix2d floor;
  floor << position(0, 0), position(0, 2), position(2, 0), position(2, 2);
  const Eigen::Vector2d flat(off.x(), off.z());
  return flat.dot(floor.inverse() * flat) <= kChi2Of2;
}

void add(Score& score, const Extrinsics& place, const Eigen::Isometry3d& exact,
         const Eigen::Vector3d& centre_in_world) {
  const PlaceError error = place_error(place.world_from_sensor, exact);
  score.position += error.position;
  score.position_worst = std::max(score.position_worst, error.position);
  score.horizontal += error.horizontal;
  score.vertical += error.vertical;
  score.yaw += error.yaw;
  score.pitch_roll += error.pitch_roll;
  score.centre += point_error(place.world_from_sensor, exact, centre_in_world);
  score.lost += error.position <= kLost ? 0U : 1U;
  score.covered += covers(place, exact) ? 1U : 0U;
  const double radius = radius_of_95(place.covariance.block<3, 3>(3, 3)({0, 2}, {0, 2}));
  score.inside += error.horizontal <= radius ? 1U : 0U;
  score.stated.push_back(radius);
  score.off.push_back(error.horizontal);
}

}  // namespace

RegistrationMethod our_registration() { return configured("ours", {}); }

std::vector<RegistrationMethod> timed_baselines() {
  RegistrationConfig necks;
  necks.joints = JointChoice::Neck;
  necks.adjust_together = false;
  RegistrationConfig plain;
  plain.adjust_together = false;
  return {estimated("trajectory-icp", necks, trajectory_icp(necks)),
          estimated("closed-form", plain, closed_form(plain))};
}

std::vector<RegistrationMethod> all_baselines() {
  RegistrationConfig icp;
  icp.method = PairMethod::IcpOnly;
  icp.joints = JointChoice::Neck;
  std::vector<RegistrationMethod> all = timed_baselines();
  all.insert(all.begin(), configured("icp", icp));
  return all;
}

std::vector<RegistrationMethod> registration_ablations() {
  const RegistrationConfig ours;
  RegistrationConfig no_floor = ours;
  no_floor.use_floor = false;
  RegistrationConfig neck = ours;
  neck.joints = JointChoice::Neck;
  RegistrationConfig apart = ours;
  apart.adjust_together = false;
  RegistrationConfig round = ours;
  round.along_ratio = 1.0;
  return {configured("no-floor", no_floor), estimated("no-robustness", ours, plain_pairs(ours)),
          configured("neck-only", neck), configured("no-adjustment", apart),
          configured("isotropic", round)};
}

Score score_of(const Workshop& workshop, const Registration& solved,
               const std::vector<SensorId>& sensors) {
  const Eigen::Vector3d centre = world_from_scene(workshop, solved.master) * kCentreInScene;
  Score score;
  for (const SensorId& sensor : sensors) {
    if (sensor == solved.master) continue;
    ++score.asked;
    const auto found = solved.sensors.find(sensor);
    if (found == solved.sensors.end()) {
      ++score.refused;
    } else {
      add(score, found->second, true_place(workshop, sensor, solved.master), centre);
    }
  }
  const auto placed = static_cast<double>(score.asked - score.refused);
  for (double* sum : {&score.position, &score.horizontal, &score.vertical, &score.yaw,
                      &score.pitch_roll, &score.centre}) {
    *sum = score.refused > 0 ? kNone : *sum / placed;
  }
  if (score.refused > 0) score.position_worst = kNone;
  return score;
}

}  // namespace chorus::bench
