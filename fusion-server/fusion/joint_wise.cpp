#include "fusion-server/fusion/joint_wise.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "fusion-server/fusion/inverse_variance.h"
#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/learned_errors.h"
#include "fusion-server/fusion/view_score.h"
#include "fusion-server/fusion/weight.h"
#include "fusion-server/fusion/weighted_mean.h"

namespace chorus::fusion {
namespace {

/// The person with one view alone: that of the highest weight; of equal ones, that with the most
/// tracked joints, then that of the smallest sensor id.  So the order of the views never matters.
Person heaviest_view_of(const Person& person) {
  const auto heavier = [](const SensorView& a, const SensorView& b) {
    const double weight_a = Weight::clamped(a.weight).value();
    const double weight_b = Weight::clamped(b.weight).value();
    const long joints_a = tracked_joints(a);
    const long joints_b = tracked_joints(b);
    return std::tie(weight_a, joints_a, b.sensor, b.body) <
           std::tie(weight_b, joints_b, a.sensor, a.body);
  };
  const auto best = std::max_element(person.views.begin(), person.views.end(), heavier);
  if (best == person.views.end()) return {person.id, {}};
  return {person.id, {*best}};
}

/// Decision 0007: when no view that saw the joint has any weight, all of them get the same weight.
void lift_zero_weights(std::vector<JointView>& views, double floor) {
  const bool any =
      std::any_of(views.begin(), views.end(), [](const JointView& s) { return s.weight > 0; });
  if (any) return;
  for (JointView& s : views) s.weight = floor;
}

class JointWise final : public Estimator {
 public:
  explicit JointWise(const FusionConfig& config)
      : config_(std::make_shared<const FusionConfig>(config)), errors_(errors_of(config)) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    if (config_->method == Method::BestView) {
      return fuse_views(heaviest_view_of(person), instant);
    }
    return fuse_views(person, instant);
  }

  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<JointWise>(*this);
  }

 private:
  [[nodiscard]] FusedBody fuse_views(const Person& person, const Instant& instant) const {
    return joint_by_joint(person.id, [&](JointId joint) {
      auto views = joint_views_of(joint, person, instant.sensors, *errors_);
      for (JointView& view : views) {
        if (!view.whole)
          view.pose_variance = pose_variance(config_->pose_error, joint, view.joint.state);
      }
      return fuse_joint(std::move(views));
    });
  }

  [[nodiscard]] FusedJoint fuse_joint(std::vector<JointView> views) const {
    if (config_->method == Method::Otto) {
      lift_zero_weights(views, config_->zero_weight_floor);
    } else {
      for (JointView& s : views) s.weight = 1.0;
    }
    FusedJoint fused = config_->method == Method::InverseVariance
                           ? inverse_variance(views, config_->huber)
                           : weighted_mean(views);
    if (!fused.joint.seen()) return fused;
    const double common = config_->common_sigma * config_->common_sigma;
    state_covariance(fused, fused.joint.covariance.matrix() + common * Eigen::Matrix3d::Identity());
    return fused;
  }

  std::shared_ptr<const FusionConfig> config_;  ///< Shared by all copies.
  std::shared_ptr<const ErrorModel> errors_;
};

}  // namespace

std::unique_ptr<Estimator> joint_wise(const FusionConfig& config) {
  return std::make_unique<JointWise>(config);
}

}  // namespace chorus::fusion
