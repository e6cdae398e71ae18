#include "fusion-server/registration/known_places.h"

#include <algorithm>

#include <fmt/format.h>

#include "fusion-server/registration/adjoint.h"

namespace chorus::registration {
namespace {

// Sigma with which the master's yaw and its position on the floor are held [rad], [m].
constexpr double kGauge = 1e-5;
constexpr double kLevelView = 0.05;  // with a smaller horizontal part a view has no direction
constexpr double kFarFloor = 4.0;    // in sigmas; a floor this far off has a quarter of its weight
constexpr double kKnownBias = 1e-6;  // [m]: sigma of a depth bias that is not estimated

/// Squared misfit of a sensor's own floor, in sigmas; 0 without one.
double floor_misfit(const Station& station) {
  if (!(station.floor.tilt > 0)) return 0.0;
  const Eigen::Vector3d up = station.world_from_level.linear().col(1);
  const double height = station.world_from_level.translation().y() / station.floor.height;
  return (up.x() * up.x() + up.z() * up.z()) / (station.floor.tilt * station.floor.tilt) +
         height * height;
}

}  // namespace

DepthBias depth_bias_of(const RegistrationConfig& config) {
  return {config.depth_bias, std::max(kKnownBias, config.depth_bias_sigma), config.depth_bias};
}

std::string advice_on(const WalkedDepthBias& found) {
  return fmt::format(
      "the sensors seem to report joints {:.0f} mm too near (+- {:.0f} mm): the places allow for "
      "it; measure it, and tell it by registration.depth_bias_m and "
      "registration.depth_bias_sigma_m",
      1e3 * found.bias, 1e3 * found.sigma);
}

double floor_loss(const Station& station) {
  constexpr double kFar = kFarFloor * kFarFloor;
  const double misfit = floor_misfit(station);
  return kFar * misfit / (kFar + misfit);
}

void add_floors(PlaceEquations& equations, const std::vector<Station>& stations) {
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!(stations[i].floor.tilt > 0) || stations[i].fixed) continue;
    Normal normal;
    // A floor is best known right below its own sensor.
    add_prior(normal, stations[i].floor, stations[i].world_from_level, Eigen::Vector3d::Zero());
    const double root = 1.0 / (1.0 + floor_misfit(stations[i]) / (kFarFloor * kFarFloor));
    const auto at = static_cast<Eigen::Index>(6 * i);
    equations.information.block<6, 6>(at, at) += root * root * normal.information;
    equations.right.segment<6>(at) += root * root * normal.right;
  }
}

void hold_gauge(PlaceEquations& equations, const std::vector<Station>& stations) {
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!stations[i].master) continue;
    const Eigen::Isometry3d place = stations[i].world_from_sensor();
    const Eigen::Vector3d view = place.linear().col(2);
    const Matrix6 eye = at_point(place.translation());
    Normal normal;
    if (stations[i].level_held) {
      for (Eigen::Index row = 0; row < 6; ++row)
        normal.add(eye.row(row), 0.0, 1.0 / (kGauge * kGauge));
    }
    normal.add(eye.row(3), 0.0, 1.0 / (kGauge * kGauge));
    normal.add(eye.row(5), 0.0, 1.0 / (kGauge * kGauge));
    Row6 turn = Row6::Zero();
    turn[1] = 1.0;
    const Eigen::Vector3d aside(view.z(), 0.0, -view.x());
    if (aside.norm() > kLevelView) {
      turn.head<3>() = view.cross(aside).transpose() / aside.squaredNorm();
    }
    normal.add(turn, 0.0, 1.0 / (kGauge * kGauge));
    const auto at = static_cast<Eigen::Index>(6 * i);
    equations.information.block<6, 6>(at, at) += normal.information;
  }
}

void hold_fixed(PlaceEquations& equations, const std::vector<Station>& stations) {
  for (std::size_t i = 0; i < stations.size(); ++i) {
    if (!stations[i].fixed) continue;
    const auto at = static_cast<Eigen::Index>(6 * i);
    equations.information.middleRows<6>(at).setZero();
    equations.information.middleCols<6>(at).setZero();
    equations.information.block<6, 6>(at, at).setIdentity();
    equations.right.segment<6>(at).setZero();
  }
}

void add_depth_bias(PlaceEquations& equations, const DepthBias& bias) {
  const Eigen::Index last = equations.right.size() - 1;
  const double weight = 1.0 / (bias.sigma * bias.sigma);
  equations.information(last, last) += weight;
  equations.right[last] -= weight * bias.beyond();
}

}  // namespace chorus::registration
