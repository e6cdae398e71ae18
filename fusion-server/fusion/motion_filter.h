// Filters a point that rests at times and moves at others: two constant-velocity filters, mixed.
//
// An interacting multiple model (IMM) of two: a stiff one for rest, an agile one for motion.  Their
// probabilities follow from how well each predicted the measurements, so that rest is smooth and
// motion does not lag (docs/papers/body.md (9)-(12)).  All noise is isotropic.  Metres, seconds.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "common/time/timestamp.h"
#include "fusion-server/flow/fused_body.h"

namespace chorus::fusion {

/// Where a point is and how it moves.
struct PointMotion {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  double variance = 0.0;  ///< Of the position, per axis [m^2].
  JointMotion motion;
};

/// The motion `passed` seconds later, if nothing is measured: the speed fades within about a
/// second, and whoever rests may set off (docs/papers/body.md (14)).
[[nodiscard]] PointMotion later(const PointMotion& now, double passed);

class MotionFilter {
 public:
  /// After a time longer than this without measurements, the filter starts anew.
  static constexpr Duration kForgotten = std::chrono::milliseconds(1000);

  struct Densities {
    double resting;  ///< Density of the white-noise acceleration [m^2 / s^3].
    double moving;
  };
  explicit MotionFilter(const Densities& densities);

  /// Takes a measurement at `instant`, later than all before, with `variance` per axis [m^2].
  void update(Timestamp instant, const Eigen::Vector3d& position, double variance);
  /// Predicted motion; none before the first update.
  [[nodiscard]] std::optional<PointMotion> at(Timestamp instant) const;
  [[nodiscard]] const std::optional<Timestamp>& updated() const { return updated_; }

 private:
  struct Model {
    double density = 0.0;
    double share = 0.5;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };
  using Models = std::array<Model, 2>;

  [[nodiscard]] PointMotion updated_motion() const;
  void begin(Timestamp instant, const Eigen::Vector3d& position, double variance);
  static void mix(Models& models, double passed);
  static void predict(Model& model, double passed);
  /// Updates one model; returns the log likelihood of the measurement.
  static double correct(Model& model, const Eigen::Vector3d& position, double variance,
                        double reach);

  std::optional<Timestamp> updated_;
  Models models_;
};

}  // namespace chorus::fusion
