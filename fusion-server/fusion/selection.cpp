#include "fusion-server/fusion/selection.h"

#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "fusion-server/fusion/joint_filters.h"
#include "fusion-server/fusion/joint_wise.h"
#include "fusion-server/fusion/view_score.h"

namespace chorus::fusion {
namespace {

using Ranked = std::vector<const SensorView*>;

/// The views, that of the highest score first; of equal ones, that of the smallest sensor id first.
template <class Score>
Ranked ranked(const Person& person, const Score& score) {
  Ranked views;
  for (const SensorView& view : person.views) views.push_back(&view);
  std::ranges::sort(views, [&](const SensorView* a, const SensorView* b) {
    return std::tuple(-score(*a), a->sensor, a->body) < std::tuple(-score(*b), b->sensor, b->body);
  });
  return views;
}

/// Turns one view into a body with the error model's covariance: the mean of a single view.
class OneView {
 public:
  explicit OneView(FusionConfig config) {
    config.method = Method::Mean;
    mean_ = joint_wise(config);
  }
  OneView(const OneView& other) : mean_(other.mean_->clone()) {}
  OneView& operator=(const OneView&) = delete;
  ~OneView() = default;

  [[nodiscard]] FusedBody body(PersonId person, const SensorView* view, const Instant& instant) {
    Person only{person, {}};
    if (view != nullptr) only.views.push_back(*view);
    return mean_->fuse(only, instant);
  }

 private:
  std::unique_ptr<Estimator> mean_;
};

/// Which sensor is used, and since when another one has been better.
class Choice {
 public:
  explicit Choice(Duration hysteresis) : hysteresis_(hysteresis) {}

  /// Null when there is no view at all.
  const SensorView* choose(const Ranked& best_first, Timestamp instant) {
    if (best_first.empty()) return nullptr;
    const SensorView* best = best_first.front();
    const auto held = std::ranges::find_if(
        best_first, [&](const SensorView* view) { return chosen_ == view->sensor; });
    const bool gone = held == best_first.end();
    if (!gone && best->sensor != (*held)->sensor) {
      if (!rival_since_) rival_since_ = instant;
      if (instant - *rival_since_ < hysteresis_) return *held;
    }
    chosen_ = best->sensor;
    rival_since_.reset();
    return best;
  }

 private:
  Duration hysteresis_;
  std::optional<SensorId> chosen_;
  std::optional<Timestamp> rival_since_;  ///< Since when another view has been better.
};

class BestSkeleton : public Estimator {
 public:
  explicit BestSkeleton(const FusionConfig& config) : view_(config), choice_(config.hysteresis) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    return view_.body(person.id, choice_.choose(ranked(person, view_score), instant.at), instant);
  }
  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<BestSkeleton>(*this);
  }

 protected:
  OneView view_;
  Choice choice_;
};

class JointCounting final : public Estimator {
 public:
  explicit JointCounting(const FusionConfig& config) : view_(config) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    const Ranked views = ranked(person, tracked_joints);
    return view_.body(person.id, views.empty() ? nullptr : views.front(), instant);
  }
  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<JointCounting>(*this);
  }

 private:
  OneView view_;
};

class Substitution final : public BestSkeleton {
 public:
  using BestSkeleton::BestSkeleton;

  FusedBody fuse(const Person& person, const Instant& instant) override {
    const Ranked views = ranked(person, view_score);
    FusedBody body = view_.body(person.id, choice_.choose(views, instant.at), instant);
    for (const SensorView* each : views) substitute(body, *each, instant);
    return body;
  }
  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<Substitution>(*this);
  }

 private:
  static bool tracked(const Joint& joint) {
    return joint.seen() && joint.state == JointState::Tracked;
  }

  /// Takes from the view the joints that it tracks and the body does not.
  void substitute(FusedBody& body, const SensorView& view, const Instant& instant) {
    std::optional<FusedBody> other;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (tracked(body.skeleton.joints[i]) || !tracked(view.skeleton.joints[i])) continue;
      if (!other) other = view_.body(body.id, &view, instant);
      put(body, static_cast<JointId>(i),
          {other->skeleton.joints[i], other->variance[i], other->contributors[i]});
    }
  }
};

}  // namespace

std::unique_ptr<Estimator> best_skeleton(const FusionConfig& config) {
  return std::make_unique<BestSkeleton>(config);
}

std::unique_ptr<Estimator> joint_counting(const FusionConfig& config) {
  return std::make_unique<JointCounting>(config);
}

std::unique_ptr<Estimator> substitution(const FusionConfig& config) {
  return std::make_unique<Substitution>(config);
}

}  // namespace chorus::fusion
