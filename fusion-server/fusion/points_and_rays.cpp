#include "fusion-server/fusion/points_and_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/geometry/rotation.h"
#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/learned_errors.h"
#include "fusion-server/fusion/least_squares.h"

namespace chorus::fusion {
namespace {

bool any_point(std::span<const JointView> views) {
  return std::ranges::any_of(views, [](const JointView& view) { return view.joint.seen(); });
}

FusedJoint finish(std::span<const JointView> views, const LeastSquares& found, double common) {
  FusedJoint fused;
  fused.joint.position = found.position;
  fused.joint.state = JointState::Inferred;
  state_covariance(fused, found.covariance + common * common * Eigen::Matrix3d::Identity());
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<double> weights;
  ShareTally tally;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (found.trust[i] == 0.0) continue;
    fused.joint.state = std::max(fused.joint.state, views[i].joint.state);
    fused.contributors |= views[i].contributor;
    tally.add(views[i].contributor, found.pull[i]);
    if (!is_unit(views[i].joint.orientation)) continue;
    rotations.push_back(views[i].joint.orientation);
    weights.push_back(found.trust[i] / mean_variance(views[i].covariance));
  }
  fused.shares = tally.shares();
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
  return fused;
}

class PointsAndRays final : public Estimator {
 public:
  explicit PointsAndRays(const FusionConfig& config)
      : config_(std::make_shared<const FusionConfig>(config)), errors_(errors_of(config)) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    return joint_by_joint(person.id, [&](JointId joint) {
      const auto views = points_and_rays_of(joint, person, instant.sensors, *errors_);
      return fuse_joint(index_of(joint), instant.at, views);
    });
  }

  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<PointsAndRays>(*this);
  }

 private:
  FusedJoint fuse_joint(std::size_t joint, Timestamp instant, const std::vector<JointView>& views) {
    if (views.empty()) return {};
    const auto found = least_squares(views, config_->huber);
    if (!found || !determined(views, *found)) return bounded(joint, instant, views);
    filters_[joint].update(instant, found->position, mean_variance(found->covariance));
    seen_[joint] = instant;
    return finish(views, *found, config_->common_sigma);
  }

  [[nodiscard]] bool determined(std::span<const JointView> views, const LeastSquares& found) const {
    return any_point(views) || largest_sigma(found.covariance) <= config_->max_sigma;
  }

  /// Fuses the joint with its predicted position as one more measurement.
  [[nodiscard]] FusedJoint bounded(std::size_t joint, Timestamp instant,
                                   std::vector<JointView> views) const {
    const auto predicted = filters_[joint].at(instant);
    const bool recent = seen_[joint] && instant >= *seen_[joint] &&
                        instant - *seen_[joint] <= config_->kalman_coast;
    if (!recent || !predicted) return {};
    JointView last;
    last.joint.position = *predicted;
    last.joint.state = JointState::Inferred;
    last.covariance = filters_[joint].variance_at(instant) * Eigen::Matrix3d::Identity();
    views.push_back(last);
    const auto found = least_squares(views, config_->huber);
    if (!found || largest_sigma(found->covariance) > config_->max_sigma) return {};
    FusedJoint fused = finish(views, *found, config_->common_sigma);
    if (fused.contributors == 0) return {};  // the joint is behind every camera that shows it
    fused.joint.state = JointState::Inferred;
    return fused;
  }

  std::shared_ptr<const FusionConfig> config_;  ///< Shared by all copies.
  std::shared_ptr<const ErrorModel> errors_;
  JointFilters filters_ = joint_filters();
  std::array<std::optional<Timestamp>, kJointCount> seen_;
};

}  // namespace

std::unique_ptr<Estimator> points_and_rays(const FusionConfig& config) {
  return std::make_unique<PointsAndRays>(config);
}

}  // namespace chorus::fusion
