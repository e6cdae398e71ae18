#include "fusion-server/fusion/otto_kalman.h"

#include <array>
#include <optional>

#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/learned_errors.h"
#include "fusion-server/fusion/weighted_mean.h"

namespace chorus::fusion {
namespace {

constexpr double kWeightFloor = 0.02;  // decision 0007: a view of weight zero counts a little

class OttoKalman final : public Estimator {
 public:
  explicit OttoKalman(const FusionConfig& config) : config_(config), errors_(errors_of(config)) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    return joint_by_joint(person.id, [&](JointId joint) {
      auto views = joint_views_of(joint, person, instant.sensors, *errors_);
      return fuse_joint(index_of(joint), instant.at, views);
    });
  }

  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<OttoKalman>(*this);
  }

 private:
  FusedJoint fuse_joint(std::size_t joint, Timestamp instant, std::vector<JointView>& views) {
    for (JointView& s : views) {
      s.weight += kWeightFloor;
      const double sigma = config_.kalman_sigma;
      filters_[joint].update(instant, s.joint.position, sigma * sigma / s.weight);
    }
    FusedJoint fused = weighted_mean(views);  // the position is replaced by the filter's below
    if (!views.empty()) seen_[joint] = instant;
    const bool coasting = seen_[joint] && instant - *seen_[joint] <= config_.kalman_coast;
    const auto position = filters_[joint].at(instant);
    if (!coasting || !position) return {};
    if (views.empty()) fused.joint.state = JointState::Inferred;
    fused.joint.position = *position;
    fused.age = seconds(instant - *seen_[joint]);
    state_covariance(fused, filters_[joint].variance_at(instant) * Eigen::Matrix3d::Identity());
    return fused;
  }

  FusionConfig config_;
  std::shared_ptr<const ErrorModel> errors_;
  JointFilters filters_ = joint_filters();
  std::array<std::optional<Timestamp>, kJointCount> seen_;
};

}  // namespace

std::unique_ptr<Estimator> otto_kalman(const FusionConfig& config) {
  return std::make_unique<OttoKalman>(config);
}

}  // namespace chorus::fusion
