#include "common/positioning/paper_smoothing.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace chorus::positioning {

std::vector<Eigen::Vector3d> gauss_smoothed(std::span<const Eigen::Vector3d> places, int steps) {
  const int reach = std::max(0, steps / 2);
  const double sigma = std::max(1e-3, reach / 3.0);
  const int count = static_cast<int>(places.size());
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double weights = 0.0;
    for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j) {
      const double weight = std::exp(-0.5 * std::pow((j - i) / sigma, 2));
      sum += weight * places[static_cast<std::size_t>(j)];
      weights += weight;
    }
    out.push_back(sum / weights);
  }
  return out;
}

std::vector<Eigen::Vector3d> kalman_smoothed(std::span<const Eigen::Vector3d> places,
                                             const KalmanSettings& settings) {
  if (places.empty()) return {};
  const double dt = settings.period;
  Eigen::Matrix2d f;
  f << 1.0, dt, 0.0, 1.0;
  const Eigen::Vector2d push(0.5 * dt * dt, dt);
  const Eigen::Matrix2d gained = std::pow(settings.acceleration, 2) * push * push.transpose();
  const double noise = settings.place * settings.place;
  // The three axes err alike, so they share one covariance.
  Eigen::Matrix<double, 2, 3> state = Eigen::Matrix<double, 2, 3>::Zero();
  state.row(0) = places.front().transpose();
  Eigen::Matrix2d covariance = Eigen::Vector2d(noise, 1.0).asDiagonal();
  std::vector<Eigen::Vector3d> out;
  for (const Eigen::Vector3d& place : places) {
    state = (f * state).eval();
    covariance = (f * covariance * f.transpose() + gained).eval();
    const Eigen::Vector2d gain = covariance.col(0) / (covariance(0, 0) + noise);
    state += gain * (place.transpose() - state.row(0));
    covariance -= (gain * covariance.row(0)).eval();
    out.emplace_back(state.row(0).transpose());
  }
  return out;
}

void gauss_smooth(std::vector<Placed>& placed) {
  std::vector<Eigen::Vector3d> places;
  for (const Placed& one : placed) places.push_back(one.online.position.place);
  const std::vector<Eigen::Vector3d> smooth = gauss_smoothed(places);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    placed[i].smooth = placed[i].online.position;
    placed[i].smooth.place = smooth[i];
  }
}

}  // namespace chorus::positioning
