// A point of the walk seen by several sensors, eliminated from the equations of the adjustment.
//
// Sensor i sees the point at m_i; T_i is the sensor's place, S_i^-1 the information of its
// measurement:
//   E(T) = min_x sum_i (T_i m_i - x)^T S_i^-1 (T_i m_i - x)
//   x = C sum_i S_i^-1 T_i m_i,   C = (sum_i S_i^-1)^-1,   S_i = sigma_i^2 (I + e r_i r_i^T)
// With a small motion (omega, tau) of T_i on the world's side and J_i = [-[T_i m_i]x  I], the Schur
// complement of x is (docs/papers/registration.md, Section 8):
//   H_ij = delta_ij J_i^T S_i^-1 J_i - J_i^T S_i^-1 C S_j^-1 J_j
//   g_i = J_i^T S_i^-1 (x - T_i m_i)
// One more unknown is common to all sensors, the depth bias b: T_i m_i + b d_i takes the place of
// T_i m_i, where d_i is the direction from the sensor to the point.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::registration {

/// One sensor's measurement of one point, in the sensor's levelled frame.  Or the difference of two
/// measurements, in which the sensor's position counts `lever` times: then read R_i m_i + lever *
/// t_i for T_i m_i, and lever * I for the I in J_i.
struct PointMeasurement {
  std::size_t sensor = 0;  ///< Index into the places.
  Eigen::Vector3d x;       ///< [m]
  Eigen::Vector3d ray;     ///< Unit line of sight.
  double sigma = 0.0;      ///< Standard deviation across the line of sight [m].
  double lever = 1.0;      ///< 1 for a measurement; less for a difference.
  /// Derivative of x by the depth bias: the direction to the point, or the difference of two.
  Eigen::Vector3d nearer = Eigen::Vector3d::Zero();
};

using PointMeasurements = std::vector<PointMeasurement>;  ///< From two or more sensors.

/// A point according to the present places.
struct FusedPoint {
  std::vector<Eigen::Vector3d> seen;            ///< Each measurement in world space.
  std::vector<Eigen::Matrix3d> information;     ///< S^-1 of each measurement.
  std::vector<Eigen::Vector3d> nearer;          ///< Derivatives of `seen` by the depth bias.
  Eigen::Vector3d x = Eigen::Vector3d::Zero();  ///< Inverse-variance mean.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// `along_ratio`: error along the line of sight over the error across it.  `depth_bias`: by how
/// much all measurements are too near [m].
[[nodiscard]] FusedPoint fuse_point(const PointMeasurements& measurements,
                                    std::span<const Eigen::Isometry3d> world_from_level,
                                    double along_ratio, double depth_bias = 0.0);

/// J_i of a measurement, seen in world space: its derivative by (omega, tau) of its sensor.
[[nodiscard]] Eigen::Matrix<double, 3, 6> derivative_of(const PointMeasurement& measured,
                                                        const Eigen::Vector3d& seen);

/// The largest residual among the point's measurements, in sigmas; it decides how much the point as
/// a whole is trusted.
[[nodiscard]] double worst_norm(const FusedPoint& fused);

/// information * (omega, tau of every sensor; depth bias) = right.
struct PlaceEquations {
  Eigen::MatrixXd information;
  Eigen::VectorXd right;
};

/// Adds H and g of one point, multiplied by `weight`; the last row is that of the depth bias.
void add_point(PlaceEquations& equations, const PointMeasurements& measurements,
               const FusedPoint& fused, double weight);

}  // namespace chorus::registration
