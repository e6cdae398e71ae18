// The Kalman filter that puts a suit's steps and what cameras say together.  Pure.
//
// State: place of SpineBase (3), error of the steps' speed along x and z (2), heading of the suit
// (1), error of the standing height (1); for each camera the relative error of its depths, which
// stays (size of the person against landmarks, focal length), and an error along and across its
// line of sight that comes and goes (3).  A camera's errors are coloured: pictures 30 ms apart err
// alike, so they are states, and what is left as noise of one picture is small.  That keeps the
// stated covariance honest.
//
// The steps of the suit are the prediction.  Standing gives the height.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

namespace chorus::positioning {

/// How wrong everything is.  The defaults are from eight real cameras with Vicon
/// (docs/benchmarks/positioner.md).
struct PositionErrors {
  double along = 0.015;   ///< Along the line of sight, relative to the distance.
  double across = 0.005;  ///< Across it, relative to the distance.
  double memory = 1.5;    ///< How long these errors stay [s].
  double depth = 0.02;    ///< Of all depths of one camera, relative.
  double picture = 0.01;  ///< Noise of one picture [m].
  double speed = 0.08;    ///< Of the steps' speed [m/s]; it stays `speed_memory`.
  double speed_memory = 0.5;
  double flight_speed = 0.4;  ///< The same in flight [m/s].
  double step = 0.05;         ///< Of the steps themselves, per square root of a second [m].
  double height = 0.03;       ///< Of the standing height [m].
  double height_memory = 1.5;
  double heading_drift = 0.003;  ///< Per square root of a second [rad].
  double heading_noise = 0.35;   ///< Of one picture's heading [rad]: pictures err alike.
};

/// Prediction: what the suit did since the last instant.
struct Motion {
  double dt = 0.0;                                  ///< [s]
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();  ///< At heading 0 of the suit [m].
  double height = 0.0;                              ///< Of SpineBase, standing [m].
  bool flies = false;
};

/// What one camera says.
struct Seen {
  std::size_t camera = 0;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< Of the place, geometry alone.
  std::optional<double> heading = {};
};

struct Position {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double heading = 0.0;
  double heading_sigma = 0.0;
};

/// One instant as the smoother needs it.
struct FilterStep {
  Eigen::VectorXd predicted, filtered;
  Eigen::MatrixXd predicted_covariance, filtered_covariance, transition;
};

class PositionFilter {
 public:
  PositionFilter(std::size_t cameras, const PositionErrors& errors);

  /// Begins at a place that a camera saw.
  void begin(const Seen& seen, double heading, double heading_sigma);
  [[nodiscard]] bool begun() const { return begun_; }

  void predict(const Motion& motion);
  /// How far this is from what is expected [variances per axis]; large when it is not this person.
  [[nodiscard]] double surprise(const Seen& seen) const;
  void see(const Seen& seen);

  [[nodiscard]] Position position() const;
  /// Relative error of a camera's depths, and its standard deviation.
  [[nodiscard]] std::pair<double, double> depth_of(std::size_t camera) const;
  /// The last instant, after predict() and all see().
  [[nodiscard]] FilterStep step() const;
  /// Makes the place unknown again, for a person who was lost.
  void forget_place();

 private:
  struct Measurement {
    Eigen::MatrixXd slope;
    Eigen::VectorXd residual;
    Eigen::MatrixXd noise;
  };
  [[nodiscard]] Measurement measured(const Seen& seen) const;
  void update(const Eigen::MatrixXd& slope, const Eigen::VectorXd& residual,
              const Eigen::MatrixXd& noise);
  void stand(const Motion& motion);

  PositionErrors errors_;
  std::size_t cameras_;
  Eigen::VectorXd state_;
  Eigen::MatrixXd covariance_;
  FilterStep step_{};
  double distance_ = 4.0;  ///< Of the person from the last camera [m].
  double restless_ = 1.0;  ///< By how much more than expected the steps err.
  bool begun_ = false;
};

/// Rauch, Tung and Striebel's smoother: each instant by all that came before and after.
[[nodiscard]] std::vector<Position> smoothed(const std::vector<FilterStep>& steps);

/// A camera's depth error as the smoother knows it: that of the last instant, when nothing is to
/// come.
[[nodiscard]] Position position_in(const Eigen::VectorXd& state, const Eigen::MatrixXd& covariance);

}  // namespace chorus::positioning
