// A body that several cameras have placed, held while one of them alone sees it.
//
// One camera shows a body's direction and its size.  The direction is certain; how far away the
// body is follows from its size, by the lengths that several cameras have found.  That size is
// wrong by a ratio that changes slowly: what a joint's depth errs by, all depths err by, now and a
// second later.  So the state is where the body has gone, its velocity, and the ratio b of the
// camera that is left (docs/papers/rays.md, One camera left):
//   v' = v e^(-t / T_v) + noise,   b' = b e^(-t / T_b) + noise
//   z  = x + D b u + e,   e across u: the rays' error; along u: D times what is white in a size
// with z the body on the camera's rays at the size of its build, D its distance and u the direction
// to it.  While several cameras place the body, x is theirs, and b is learned of each.
#pragma once

#include <array>
#include <map>
#include <optional>

#include "common/base/strong_id.h"
#include "fusion-server/fusion/bone_lengths.h"

namespace chorus::fusion {

/// What one camera shows of a body.
struct RayView {
  SensorId sensor;
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  /// Unit directions to the joints; `placed`: there is one.  The covariance is that of the
  /// direction [rad^2].
  PlacedBody rays;
  /// Guessed distances along them [m]; 0: none, as from a ray.
  std::array<double, kJointCount> depth{};
};

class HeldBody {
 public:
  explicit HeldBody(const BodyModel& model) : model_(model) {}

  /// Where the joints are expected `passed` seconds after the last call.
  void predict(double passed);
  /// Takes a body that several cameras have placed; after predict().
  void take(const PlacedBody& seen);
  /// Learns by what ratio a camera has the depths of that body wrong.
  void compare(const RayView& view, const PlacedBody& seen);
  /// The body according to one camera alone; after predict().  None if too little is held, or the
  /// camera shows too few of the held joints.
  [[nodiscard]] std::optional<PlacedBody> follow(const RayView& view);
  [[nodiscard]] const PlacedBody& expected() const { return body_; }

 private:
  /// The ratio by which a camera has sizes wrong.
  struct Ratio {
    double value = 0.0;
    double variance = 0.0;
  };
  using State = Eigen::Matrix<double, 7, 1>;  ///< Way [m], velocity [m/s], ratio.
  using Spread = Eigen::Matrix<double, 7, 7>;
  using Slopes = Eigen::Matrix<double, 3, 7>;

  [[nodiscard]] PlacedBody on_rays(const RayView& view) const;
  [[nodiscard]] PlacedBody enlarged(PlacedBody points, const Eigen::Vector3d& eye) const;
  void grow_older(double passed);
  void leave();
  void use(const RayView& view);
  void correct(const Slopes& slopes, const Eigen::Vector3d& way, const Eigen::Matrix3d& noise);
  void replace(const PlacedBody& now);

  BodyModel model_;
  BoneLengths lengths_;
  HeldBones bones_;  ///< Of `lengths_`.
  std::map<SensorId, Ratio> ratios_;
  std::optional<SensorId> left_;  ///< The camera whose ratio is in the state.
  PlacedBody body_;
  std::array<double, kJointCount> unseen_{};  ///< Time since a joint was placed [s].
  double passed_ = 0.0;
  State state_ = State::Zero();
  Spread spread_ = Spread::Zero();
};

}  // namespace chorus::fusion
