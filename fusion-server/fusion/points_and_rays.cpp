#include "fusion-server/fusion/points_and_rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "common/base/square.h"
#include "common/geometry/ray.h"
#include "common/geometry/rotation.h"
#include "fusion-server/fusion/disagreement.h"
#include "fusion-server/fusion/held_body.h"
#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/landmark_error.h"
#include "fusion-server/fusion/learned_errors.h"
#include "fusion-server/fusion/least_squares.h"
#include "fusion-server/fusion/methods.h"
#include "fusion-server/fusion/source_fade.h"

namespace chorus::fusion {
namespace {

constexpr std::size_t kEnough = 3;  // joints that several cameras place: they place the body

bool any_point(std::span<const JointView> views) {
  return std::ranges::any_of(views, [](const JointView& view) { return view.joint.seen(); });
}

/// A joint's views at an instant, and where they meet.
struct Meeting {
  std::vector<JointView> views;
  std::optional<LeastSquares> found;
};
using Meetings = std::array<Meeting, kJointCount>;

/// State, orientation, contributors and their shares by the views that are trusted.
void show(FusedJoint& fused, std::span<const JointView> views, std::span<const double> trust,
          std::span<const double> pull) {
  fused.joint.state = JointState::Inferred;
  std::vector<Eigen::Quaterniond> rotations;
  std::vector<double> weights;
  ShareTally tally;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (trust[i] == 0.0) continue;
    fused.joint.state = std::max(fused.joint.state, views[i].joint.state);
    fused.contributors |= views[i].contributor;
    tally.add(views[i].contributor, pull[i]);
    if (!is_unit(views[i].joint.orientation)) continue;
    rotations.push_back(views[i].joint.orientation);
    weights.push_back(trust[i] / mean_variance(views[i].covariance));
  }
  fused.shares = tally.shares();
  if (!rotations.empty()) fused.joint.orientation = weighted_lerp(rotations, weights);
}

FusedJoint finish(std::span<const JointView> views, const LeastSquares& found, double common) {
  FusedJoint fused;
  fused.joint.position = found.position;
  state_covariance(fused, found.covariance + common * common * Eigen::Matrix3d::Identity());
  show(fused, views, found.trust, found.pull);
  return fused;
}

/// By how far cameras miss the place where they meet, across their lines of sight.  None if others
/// show the joint, too.
ShownDifference difference_of(const Meeting& meeting) {
  constexpr double kAxes = 3.0;
  ShownDifference shown;
  if (!meeting.found || !from_cameras(meeting.views)) return shown;
  for (std::size_t i = 0; i < meeting.views.size(); ++i) {
    const JointView& view = meeting.views[i];
    const Eigen::Vector3d way = meeting.found->position - view.eye;
    const Eigen::Vector3d to =
        view.joint.bears() ? view.joint.position : Eigen::Vector3d(view.joint.position - view.eye);
    const Eigen::Vector3d ray = to.normalized();
    const double miss = (way - way.dot(ray) * ray).squaredNorm();
    const double across = (view.covariance.trace() - ray.dot(view.covariance * ray)) / 2.0;
    const double square = view.joint.bears() ? across * way.squaredNorm() : across;
    shown.sum += meeting.found->trust[i] * miss / square / kAxes;
    shown.free += 2.0 / kAxes;
  }
  shown.free -= 1.0;
  return shown.free > 0 && std::isfinite(shown.sum) ? shown : ShownDifference{};
}

/// True if the views place the joint: by a point of known depth, or from two sides.
bool is_placed(const Meeting& meeting, double max_sigma) {
  if (!meeting.found || largest_sigma(meeting.found->covariance) > max_sigma) return false;
  std::optional<std::size_t> first;
  for (std::size_t i = 0; i < meeting.views.size(); ++i) {
    const JointView& view = meeting.views[i];
    if (meeting.found->trust[i] == 0.0) continue;
    if (view.joint.seen() && !nearly_a_ray(view.joint)) return true;
    if (first && *first != view.view) return true;
    first = view.view;
  }
  return false;
}

/// What one of the views shows.
RayView ray_view(const Person& person, std::size_t index, const Meetings& meetings) {
  RayView shown{person.views[index].sensor, person.views[index].eye, {}, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    for (const JointView& view : meetings[j].views) {
      if (view.view != index) continue;
      const Eigen::Vector3d way = view.joint.position - shown.eye;
      if (view.joint.bears()) {
        shown.rays[j] = {view.joint.position, view.covariance, true};
      } else if (way.norm() > 0) {
        shown.depth[j] = way.norm();
        shown.rays[j] = {way.normalized(), view.covariance / way.squaredNorm(), true};
      }
    }
  }
  return shown;
}

/// The view that shows most joints.
std::size_t fullest(const Person& person, const Meetings& meetings) {
  std::vector<std::size_t> joints(person.views.size(), 0);
  for (const Meeting& meeting : meetings) {
    for (const JointView& view : meeting.views) ++joints[view.view];
  }
  return static_cast<std::size_t>(std::ranges::max_element(joints) - joints.begin());
}

class PointsAndRays final : public Estimator {
 public:
  explicit PointsAndRays(const FusionConfig& config)
      : config_(std::make_shared<const FusionConfig>(config)),
        errors_(errors_of(config)),
        held_(config.body) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    const double passed = step_to(instant.at);
    const PlacedBody expected = held_.expected();
    Meetings meetings;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      meetings[j].views =
          points_and_rays_of(static_cast<JointId>(j), person, instant.sensors, *errors_);
      meetings[j].found = least_squares(meetings[j].views, config_->huber);
    }
    learn_differences(meetings, passed);
    const Holding held = hold(person, meetings);
    FusedBody body = joint_by_joint(person.id, [&](JointId joint) {
      const std::size_t j = index_of(joint);
      const bool by_one = held.body && (*held.body)[j].placed;
      FusedJoint fused = by_one ? held_joint(meetings[j], (*held.body)[j])
                                : fuse_joint(j, instant.at, meetings[j]);
      if (from_cameras(meetings[j].views)) state_landmark_error(fused, joint);
      return fused;
    });
    const bool changed = held.source && source_ && *held.source != *source_;
    if (held.source) source_ = held.source;
    fade_.apply(body, expected, changed, passed);
    return body;
  }

  /// The body takes the place of one that several cameras have placed.
  void attend(const FusedBody& body, const Person& person, const Instant& instant) override {
    (void)step_to(instant.at);
    PlacedBody placed;
    std::size_t count = 0;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const Joint& joint = body.skeleton.joints[j];
      if (!joint.seen() || body.contributors[j] == 0) continue;
      placed[j] = {joint.position,
                   joint.covariance.known() ? joint.covariance.matrix()
                                            : body.variance[j] * Eigen::Matrix3d::Identity(),
                   true};
      ++count;
    }
    if (count < kEnough) return;
    Meetings shown;
    for (std::size_t j = 0; j < kJointCount; ++j)
      shown[j].views =
          points_and_rays_of(static_cast<JointId>(j), person, instant.sensors, *errors_);
    take(placed, person, shown, [](const SensorView& view) { return is_of_a_camera(view); });
    source_ = Source{};
  }

  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<PointsAndRays>(*this);
  }

 private:
  /// Who places the body: several cameras, or one alone.
  struct Source {
    std::optional<SensorId> alone;
    bool operator==(const Source&) const = default;
  };

  struct Holding {
    std::optional<Source> source;    ///< None if nobody places the body.
    std::optional<PlacedBody> body;  ///< According to one camera; none: not asked.
  };

  /// Predicts the held body; returns the time since the last instant [s].
  double step_to(Timestamp instant) {
    const double passed = last_ ? std::max(0.0, seconds(instant - *last_)) : 0.0;
    last_ = instant;
    held_.predict(passed);
    return passed;
  }

  /// Takes a body that others than one camera have placed, and compares these views with it.
  void take(const PlacedBody& placed, const Person& person, const Meetings& meetings,
            bool (*wanted)(const SensorView&)) {
    held_.take(placed);
    for (std::size_t v = 0; v < person.views.size(); ++v) {
      if (wanted(person.views[v])) held_.compare(ray_view(person, v, meetings), placed);
    }
  }

  void learn_differences(const Meetings& meetings, double passed) {
    ShownDifferences shown;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      shown[j] = difference_of(meetings[j]);
      misses_[j] = shown[j].free > 0;
    }
    differ_.learn(shown, passed);
  }

  /// Cameras that meet more closely than their errors say have smaller ones; that they meet less
  /// closely, the instant itself shows.
  [[nodiscard]] LeastSquares as_they_meet(const LeastSquares& found, std::size_t joint) const {
    LeastSquares told = found;
    if (misses_[joint]) told.covariance *= std::min(1.0, differ_.value(joint));
    return told;
  }

  /// Gives the held body what the views show of it.
  Holding hold(const Person& person, const Meetings& meetings) {
    PlacedBody placed;
    std::size_t count = 0;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      if (!is_placed(meetings[j], config_->max_sigma)) continue;
      placed[j] = {meetings[j].found->position, meetings[j].found->covariance, true};
      ++count;
    }
    if (count >= kEnough) {
      take(placed, person, meetings, [](const SensorView&) { return true; });
      return {Source{}, {}};
    }
    if (person.views.empty()) return {};
    const RayView view = ray_view(person, fullest(person, meetings), meetings);
    auto body = held_.follow(view);
    if (!body) return {};
    return {Source{view.sensor}, std::move(body)};
  }

  /// A joint on the ray of the camera that is left.
  [[nodiscard]] FusedJoint held_joint(const Meeting& meeting, const PlacedJoint& place) const {
    FusedJoint fused;
    fused.joint.position = place.position;
    state_covariance(
        fused, place.covariance + square(config_->common_sigma) * Eigen::Matrix3d::Identity());
    const std::vector<double> all(meeting.views.size(), 1.0);
    show(fused, meeting.views, all, all);
    if (!any_point(meeting.views)) fused.joint.state = JointState::Inferred;
    return fused;
  }

  FusedJoint fuse_joint(std::size_t joint, Timestamp instant, const Meeting& meeting) {
    const auto& [views, found] = meeting;
    if (views.empty()) return {};
    if (!found || !determined(views, *found)) return bounded(joint, instant, views);
    filters_[joint].update(instant, found->position, mean_variance(found->covariance));
    seen_[joint] = instant;
    return finish(views, as_they_meet(*found, joint), config_->common_sigma);
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
  HeldBody held_;
  Disagreement differ_{1.0};                ///< Of rays that state no covariance.
  std::array<bool, kJointCount> misses_{};  ///< True if the joint showed something of that.
  std::optional<Source> source_;            ///< Who last placed the body.
  SourceFade fade_;
  std::optional<Timestamp> last_;
  JointFilters filters_ = joint_filters();
  std::array<std::optional<Timestamp>, kJointCount> seen_;
};

}  // namespace

std::unique_ptr<Estimator> points_and_rays(const FusionConfig& config) {
  return std::make_unique<PointsAndRays>(config);
}

}  // namespace chorus::fusion
