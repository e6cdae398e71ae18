#include "fusion-server/fusion/body_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/bone_lengths.h"
#include "fusion-server/fusion/disagreement.h"
#include "fusion-server/fusion/handover.h"
#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/learned_errors.h"
#include "fusion-server/fusion/limb_ends.h"
#include "fusion-server/fusion/misfit_size.h"
#include "fusion-server/fusion/motion_filter.h"
#include "fusion-server/fusion/sighted_body.h"

namespace chorus::fusion {
namespace {

constexpr double kHabit = 5.0;        // [s] time constant of a Habit
constexpr double kUsualScale = 0.01;  // relative differences in size that noise alone causes
// [m]; shoulders that are closer together, seen from above, show no direction.
constexpr double kNarrowShoulders = 0.1;
// [rad]; shoulders of somebody who stands still waver by less than this.
constexpr double kPlay = deg(4);

/// A mean that follows new values slowly.
struct Habit {
  double value = 0.0;

  void follow(const std::optional<double>& now, double passed) {
    if (now) value += std::min(1.0, passed / kHabit) * (*now - value);
  }
};

using MotionFilters = std::array<MotionFilter, kJointCount>;

MotionFilter motion_filter(JointId joint, const BodyModel& model) {
  const double lively = in_trunk(joint) ? 1.0 : model.limb;
  return MotionFilter({lively * model.resting, lively * model.moving});
}

template <std::size_t... I>
MotionFilters motion_filters(const BodyModel& model, std::index_sequence<I...>) {
  return {motion_filter(static_cast<JointId>(I), model)...};
}

class BodyFilter final : public Estimator {
 public:
  explicit BodyFilter(const FusionConfig& config)
      : config_(std::make_shared<const FusionConfig>(config)),
        errors_(errors_of(config)),
        filters_(motion_filters(config.body, std::make_index_sequence<kJointCount>{})),
        disagreement_(config.body.disagreement) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    const double passed = last_ ? std::max(0.0, seconds(instant.at - *last_)) : 0.0;
    last_ = instant.at;
    const PlacedBody expected = expected_at(instant.at);
    SightedBody sighted(person, instant, *errors_, *config_, biases_);
    sighted.settle(lengths_.held(model()), expected, misfits_.found(model()));
    misfits_.learn(sighted.misfits(), passed, model());
    lengths_.learn(sighted.placed(), passed, model());
    if (model().handover > Duration{0}) {
      handover_.take(sighted.pulls(), passed, model().handover);
      if (model().leap > 0) hold_leaps(sighted.placed(), expected, instant.at);
    }
    const StatedVariances stated = sighted.stated_variances();
    limb_ends_.learn(sighted.placed(), stated, passed, model());
    const PlacedBody whole =
        held(limb_ends_.held(handed_over(sighted.placed()), stated, model()), expected);
    if (model().bias_rate > 0) sighted.learn(biases_, whole, passed, turned(whole));
    disagreement_.learn(sighted.disagreement(), passed);
    scale_square_.follow(sighted.scale_square(), passed);
    middle_ = middle_of(whole);
    if (!sighted.misfits().empty()) turn_sigma_ = sighted.turn_sigma();
    FusedBody body = joint_by_joint(person.id, [&](JointId joint) {
      return whole[index_of(joint)].placed ? fused(sighted, joint, instant.at, whole)
                                           : FusedJoint{};
    });
    body.motion = motion_at(instant.at);
    body.bones = bones();
    body.stature = stature_of(*body.bones);
    return body;
  }

  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<BodyFilter>(*this);
  }

 private:
  [[nodiscard]] const BodyModel& model() const { return config_->body; }

  /// The angle by which the shoulders have turned since both were last placed [rad]; 0 if unknown.
  /// Turns within kPlay do not count: otherwise the noise of every instant would add up, and a
  /// still person would turn faster at higher frame rates.
  [[nodiscard]] double turned(const PlacedBody& body) {
    const PlacedJoint& left = body[index_of(JointId::ShoulderLeft)];
    const PlacedJoint& right = body[index_of(JointId::ShoulderRight)];
    if (!left.placed || !right.placed) return 0.0;
    const Eigen::Vector3d across = left.position - right.position;
    if (std::hypot(across.x(), across.z()) < kNarrowShoulders) return 0.0;  // no direction
    const double off = wrap_angle(std::atan2(across.z(), across.x()) - yaw_);
    const double beyond = std::max(0.0, std::abs(off) - kPlay);
    yaw_ = wrap_angle(yaw_ + std::copysign(beyond, off));
    return beyond;
  }

  /// A joint that was measured before moves on from where it is expected, or two views tell of it.
  void hold_leaps(const PlacedBody& seen, const PlacedBody& expected, Timestamp instant) {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto& before = filters_[j].updated();
      if (!seen[j].placed || !expected[j].placed || !before) continue;
      const double times = std::max(1.0, seconds(instant - *before) / BodyModel::kLeapTime);
      handover_.hold_leap(j, seen[j].position, expected[j].position, times * model().leap);
    }
  }

  [[nodiscard]] PlacedBody handed_over(PlacedBody body) const {
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (body[j].placed) body[j].position += handover_.offset(j);
    }
    return body;
  }

  /// The seen body, completed by what is expected, its bones held at the learned lengths.
  [[nodiscard]] PlacedBody held(PlacedBody body, const PlacedBody& expected) const {
    const bool unseen = std::ranges::none_of(body, &PlacedJoint::placed);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!body[j].placed) body[j] = expected[j];
    }
    PlacedBody whole = hold_bones(body, lengths_.held(model()));
    // Nobody knows where an unseen body has gone as a whole, so its bones make no joint more
    // certain.
    for (std::size_t j = 0; unseen && j < kJointCount; ++j)
      whole[j].covariance = body[j].covariance;
    return whole;
  }

  [[nodiscard]] FusedJoint fused(const SightedBody& sighted, JointId joint, Timestamp instant,
                                 const PlacedBody& whole) {
    const std::size_t j = index_of(joint);
    const PlacedJoint& now = whole[j];
    const bool determined = sighted.determined(j);
    FusedJoint fused = sighted.shown(joint);
    if (!determined) fused.joint.state = JointState::Inferred;
    PlacedJoint place = filtered(j, instant, now, determined);
    if (determined) {
      plain_views_[j] = sighted.plain_views(j);
      const Eigen::Matrix3d beyond = limb_ends_.left(j) * sighted.stated(j) - now.covariance;
      beyond_[j] = std::max(0.0, mean_variance(beyond));
      place.covariance += beyond;
    } else {
      place.covariance += beyond_[j] * Eigen::Matrix3d::Identity();
    }
    state(fused, place, j, turn_covariance(j, whole, turn_sigma_));
    if (fused.contributors != 0) contributed_[j] = instant;
    if (contributed_[j]) fused.age = seconds(instant - *contributed_[j]);
    return fused;
  }

  /// Predicted positions of the joints that were seen recently.
  [[nodiscard]] PlacedBody expected_at(Timestamp instant) const {
    PlacedBody body;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto& updated = filters_[j].updated();
      if (!updated || instant < *updated || instant - *updated > model().carry) continue;
      const auto motion = filters_[j].at(instant);
      const double variance = motion->variance + slow_[j];
      body[j] = {motion->position, variance * Eigen::Matrix3d::Identity(), true};
    }
    return body;
  }

  [[nodiscard]] BoneLengthOf bones() const {
    const HeldBones held = lengths_.held(model());
    BoneLengthOf bones;
    for (std::size_t b = 0; b < kBones.size(); ++b)
      bones[index_of(kBones[b].child)] = {held[b].length, held[b].sigma};
    return bones;
  }

  [[nodiscard]] std::array<JointMotion, kJointCount> motion_at(Timestamp instant) const {
    std::array<JointMotion, kJointCount> all;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto point = filters_[j].at(instant);
      if (!point) continue;
      all[j] = point->motion;
      all[j].place_variance = point->variance;
      all[j].measured = model().resting > 0 && filters_[j].updated() == instant;
    }
    return all;
  }

  /// The joint after filtering; the filter takes only joints that views determined.
  PlacedJoint filtered(std::size_t j, Timestamp instant, const PlacedJoint& now, bool determined) {
    if (!determined) return now;
    slow_[j] = mean_variance(now.covariance);
    const double white = model().white * model().white;
    filters_[j].update(instant, now.position, white * slow_[j]);
    if (!(model().resting > 0)) return now;
    const auto motion = filters_[j].at(instant);
    return {motion->position, now.covariance + motion->variance * Eigen::Matrix3d::Identity(),
            true};
  }

  /// Sets position and covariance of joint `j`.  Errors that all views have in common are added to
  /// the covariance, because no view's covariance contains them.
  void state(FusedJoint& fused, const PlacedJoint& place, std::size_t j,
             const Eigen::Matrix3d& turned) const {
    const BodyModel& body = model();
    // Covariances that sensors state themselves are believed as they are.
    const bool adapted = body.disagreement > 0 && plain_views_[j] > 0;
    // What views show of a joint says nothing of how far it goes unseen.
    const double shown = fused.contributors != 0
                             ? disagreement_.value(j)
                             : std::max(disagreement_.value(), disagreement_.value(j));
    const double differ = adapted ? shown : 1.0;
    const double wider = adapted ? differ * unseen_error(plain_views_[j]) : 1.0;
    const double alike = adapted ? body.common * disagreement_.value() : 0.0;
    const double uneven = std::max(0.0, scale_square_.value - kUsualScale * kUsualScale);
    const double reach = middle_ ? (place.position - *middle_).squaredNorm() : 0.0;
    const double common = config_->common_sigma * config_->common_sigma + alike * alike +
                          body.proportion * body.proportion * uneven * reach;
    fused.joint.position = place.position;
    state_covariance(fused,
                     wider * place.covariance + turned + common * Eigen::Matrix3d::Identity());
  }

  std::shared_ptr<const FusionConfig> config_;  ///< Shared by all copies.
  std::shared_ptr<const ErrorModel> errors_;
  BoneLengths lengths_;
  MisfitSize misfits_;
  Biases biases_;
  Handover handover_;
  LimbEnds limb_ends_;
  MotionFilters filters_;
  std::array<double, kJointCount> slow_{};  ///< Variance of a joint when last determined [m^2].
  /// What was stated in addition to that, per axis [m^2].  It is kept while nobody sees the joint,
  /// because the stated error must not shrink then.
  std::array<double, kJointCount> beyond_{};
  std::array<std::optional<Timestamp>, kJointCount> contributed_;  ///< When a sensor last did.
  /// Number of views that determined a joint, by points without a covariance of their own, when
  /// it last was.
  std::array<std::size_t, kJointCount> plain_views_{};
  Disagreement disagreement_;
  Habit scale_square_;
  std::optional<Eigen::Vector3d> middle_;  ///< Middle of the trunk.
  double turn_sigma_ = 0.0;  ///< SightedBody::turn_sigma() when somebody last saw them.
  double yaw_ = 0.0;         ///< Yaw of the shoulders, to within kPlay [rad].
  std::optional<Timestamp> last_;
};

}  // namespace

std::unique_ptr<Estimator> body_filter(const FusionConfig& config) {
  return std::make_unique<BodyFilter>(config);
}

}  // namespace chorus::fusion
