#include "tests/bench/methods/selection.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

namespace chorus::bench::baselines {
namespace {

long tracked_joints(const SensorView& view) {
  return std::ranges::count(view.skeleton.joints, JointState::Tracked, &Joint::state);
}

/// Best first; of equals the smallest sensor id.
std::vector<const SensorView*> by_score(const Person& person) {
  std::vector<const SensorView*> views;
  for (const SensorView& view : person.views) views.push_back(&view);
  std::ranges::sort(views, [](const SensorView* a, const SensorView* b) {
    return std::tuple(-skeleton_score(*a), a->sensor) < std::tuple(-skeleton_score(*b), b->sensor);
  });
  return views;
}

/// The sensor that is trusted, and since when another one has looked better.
class Choice {
 public:
  /// Null when there is no view at all.
  const SensorView* choose(const std::vector<const SensorView*>& best_first, Timestamp instant) {
    if (best_first.empty()) return nullptr;
    const SensorView* best = best_first.front();
    const auto held = std::ranges::find_if(
        best_first, [&](const SensorView* view) { return chosen_ == view->sensor; });
    if (held == best_first.end()) {
      chosen_ = best->sensor;
      rival_since_.reset();
      return best;
    }
    if (*held == best) {
      rival_since_.reset();
      return best;
    }
    if (!rival_since_) rival_since_ = instant;
    if (instant - *rival_since_ < kHysteresis) return *held;
    chosen_ = best->sensor;
    rival_since_.reset();
    return best;
  }

 private:
  std::optional<SensorId> chosen_;
  std::optional<Timestamp> rival_since_;
};

}  // namespace

double skeleton_score(const SensorView& view) {
  const double tracked = static_cast<double>(tracked_joints(view)) / kJointCount;
  const double squarely = std::isfinite(view.facing) ? std::cos(view.facing) : 0.0;
  return tracked + 0.5 * (1.0 + squarely);
}

Method best_skeleton() {
  return [choice = Choice{}](const Person& person, Timestamp instant) mutable {
    const SensorView* chosen = choice.choose(by_score(person), instant);
    return chosen ? chosen->skeleton : Body{};
  };
}

Method joint_counting() {
  return [](const Person& person, Timestamp) {
    const auto most = std::ranges::min_element(person.views, {}, [](const SensorView& v) {
      return std::tuple(-tracked_joints(v), v.sensor);
    });
    return most == person.views.end() ? Body{} : most->skeleton;
  };
}

Method substitution() {
  return [choice = Choice{}](const Person& person, Timestamp instant) mutable {
    const auto best_first = by_score(person);
    const SensorView* chosen = choice.choose(best_first, instant);
    if (!chosen) return Body{};
    Body body = chosen->skeleton;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (body.joints[i].state == JointState::Tracked) continue;
      const auto other = std::ranges::find_if(best_first, [i](const SensorView* view) {
        return view->skeleton.joints[i].state == JointState::Tracked;
      });
      if (other != best_first.end()) body.joints[i] = (*other)->skeleton.joints[i];
    }
    return body;
  };
}

}  // namespace chorus::bench::baselines
