#include "fusion-server/fusion/otto_kalman.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "common/body/bones.h"
#include "fusion-server/fusion/joint_view.h"
#include "fusion-server/fusion/point_filter.h"
#include "fusion-server/fusion/weighted_mean.h"

namespace chorus::fusion {
namespace {

constexpr double kTrunkDensity = 3.0;
constexpr double kLimbDensity = 40.0;
constexpr double kWeightFloor = 0.02;  // decision 0007: a view of weight zero says a little

template <std::size_t... I>
std::array<PointFilter, kJointCount> filters(std::index_sequence<I...>) {
  return {PointFilter(process_density(static_cast<JointId>(I)))...};
}

class OttoKalman final : public Estimator {
 public:
  explicit OttoKalman(const FusionConfig& config)
      : config_(config), errors_(line_of_sight_errors(config.noise, config.sensor_noise)) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    FusedBody body;
    body.id = person.id;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      auto views = joint_views_of(static_cast<JointId>(i), person, instant.sensors, *errors_);
      const FusedJoint fused = fuse_joint(i, instant.at, views);
      body.skeleton.joints[i] = fused.joint;
      body.variance[i] = fused.variance;
      body.contributors[i] = fused.contributors;
    }
    return body;
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
    FusedJoint fused = weighted_mean(views);  // state, orientation, contributors
    if (!views.empty()) seen_[joint] = instant;
    const bool coasting = seen_[joint] && instant - *seen_[joint] <= config_.kalman_coast;
    const auto position = filters_[joint].at(instant);
    if (!coasting || !position) return {};
    if (views.empty()) fused.joint.state = JointState::Inferred;
    fused.joint.position = *position;
    state_covariance(fused, filters_[joint].variance_at(instant) * Eigen::Matrix3d::Identity());
    return fused;
  }

  FusionConfig config_;
  std::shared_ptr<const ErrorModel> errors_;
  std::array<PointFilter, kJointCount> filters_ = filters(std::make_index_sequence<kJointCount>{});
  std::array<std::optional<Timestamp>, kJointCount> seen_;
};

}  // namespace

double process_density(JointId joint) {
  const bool trunk = std::ranges::find(kCoreJoints, joint) != kCoreJoints.end();
  return trunk ? kTrunkDensity : kLimbDensity;
}

std::unique_ptr<Estimator> otto_kalman(const FusionConfig& config) {
  return std::make_unique<OttoKalman>(config);
}

}  // namespace chorus::fusion
