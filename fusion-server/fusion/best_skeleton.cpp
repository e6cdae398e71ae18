#include "fusion-server/fusion/best_skeleton.h"

#include <algorithm>
#include <optional>
#include <tuple>

#include "fusion-server/fusion/joint_wise.h"
#include "fusion-server/fusion/view_score.h"

namespace chorus::fusion {
namespace {

/// The highest score; of equals the smallest sensor id; null when there is no view.
const SensorView* best_of(const Person& person) {
  const SensorView* best = nullptr;
  for (const SensorView& view : person.views) {
    const auto rank = [](const SensorView& v) {
      return std::tuple(-view_score(v), v.sensor, v.body);
    };
    if (best == nullptr || rank(view) < rank(*best)) best = &view;
  }
  return best;
}

class BestSkeleton final : public Estimator {
 public:
  explicit BestSkeleton(const FusionConfig& config)
      : hysteresis_(config.hysteresis), alone_(alone(config)) {}
  BestSkeleton(const BestSkeleton& other)
      : hysteresis_(other.hysteresis_),
        alone_(other.alone_->clone()),
        chosen_(other.chosen_),
        rival_since_(other.rival_since_) {}

  FusedBody fuse(const Person& person, const Instant& instant) override {
    const SensorView* view = choose(person, instant.at);
    Person only{person.id, {}};
    if (view != nullptr) only.views.push_back(*view);
    return alone_->fuse(only, instant);
  }

  [[nodiscard]] std::unique_ptr<Estimator> clone() const override {
    return std::make_unique<BestSkeleton>(*this);
  }

 private:
  /// The weighted mean of a single view is that view, with the error model's covariance.
  static std::unique_ptr<Estimator> alone(FusionConfig config) {
    config.method = Method::Mean;
    return joint_wise(config);
  }

  const SensorView* choose(const Person& person, Timestamp instant) {
    const SensorView* best = best_of(person);
    if (best == nullptr) return nullptr;
    const auto held = std::ranges::find_if(
        person.views, [&](const SensorView& view) { return chosen_ == view.sensor; });
    const bool gone = held == person.views.end();
    if (!gone && best->sensor != held->sensor) {
      if (!rival_since_) rival_since_ = instant;
      if (instant - *rival_since_ < hysteresis_) return &*held;
    }
    chosen_ = best->sensor;
    rival_since_.reset();
    return best;
  }

  Duration hysteresis_;
  std::unique_ptr<Estimator> alone_;
  std::optional<SensorId> chosen_;
  std::optional<Timestamp> rival_since_;  ///< Since when another view has scored higher.
};

}  // namespace

std::unique_ptr<Estimator> best_skeleton(const FusionConfig& config) {
  return std::make_unique<BestSkeleton>(config);
}

}  // namespace chorus::fusion
