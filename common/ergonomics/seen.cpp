#include "common/ergonomics/seen.h"

#include <algorithm>
#include <cmath>

#include "common/ergonomics/limits.h"

namespace chorus::ergonomics {
namespace {

struct Leg {
  double thigh, knee, shank, lift, height;

  [[nodiscard]] bool known() const { return std::isfinite(thigh + knee + shank + lift + height); }
};

Leg leg_of(const Measures& measures, Side side) {
  return {measures.at(Limb::ThighInclination, side), measures.at(Limb::KneeFlexion, side),
          measures.at(Limb::ShankInclination, side), measures.at(Limb::FootLift, side),
          measures.at(Limb::KneeHeight, side)};
}

bool kneels(const Leg& leg) {
  return leg.height < limits().knee_on_floor && leg.shank > limits().shank_lying;
}

bool sits(const Leg& leg) {
  return leg.thigh > limits().thigh_level && leg.shank < limits().shank_upright &&
         leg.knee < limits().seated_knee;
}

}  // namespace

std::optional<Legs> legs_of(const Seen& seen) {
  const Leg left = leg_of(seen.measures, Side::Left);
  const Leg right = leg_of(seen.measures, Side::Right);
  if (!left.known() || !right.known()) return std::nullopt;
  if (kneels(left) || kneels(right)) return Legs::Kneeling;
  if (sits(left) && sits(right)) return Legs::Sitting;
  if (seen.walking) return Legs::Walking;
  const bool one = std::max(left.lift, right.lift) > limits().foot_lifted;
  if (!one)
    return std::max(left.knee, right.knee) > limits().owas_knee ? Legs::Bent : Legs::Straight;
  const double bearing = left.lift > right.lift ? right.knee : left.knee;
  return bearing > limits().owas_knee ? Legs::OneBent : Legs::OneStraight;
}

double knee_of(const Seen& seen) {
  const double left = seen.measures.at(Limb::KneeFlexion, Side::Left);
  const double right = seen.measures.at(Limb::KneeFlexion, Side::Right);
  if (std::isnan(left) || std::isnan(right)) return std::nan("");
  return std::max(left, right);
}

std::optional<bool> trunk_asymmetric(const Seen& seen, double twist, double side) {
  const double twisted = std::abs(seen.measures[Centre::TrunkTwist]);
  const double leaning = std::abs(seen.measures[Centre::TrunkSideBend]);
  if (twisted > twist || leaning > side) return true;
  if (std::isnan(twisted) || std::isnan(leaning)) return std::nullopt;
  return false;
}

}  // namespace chorus::ergonomics
