#include "fusion-server/facing/shoulder_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "fusion-server/facing/lateral.h"

namespace chorus::facing {
namespace {

constexpr double kSquare = deg(40);  // Otto 3.2: yaw is reliable up to here.
constexpr double kJump = deg(90);    // Nobody turns this far between two frames.
constexpr double kMemory = 0.5;      // [s]; over which states are averaged.
constexpr double kMostly = 0.8;      // A share of frames that settles it.
constexpr double kLongestGap = 1.0;  // [s]; after it a body counts as new.

bool collar_tracked(const Skeleton<WorldSpace>& body) {
  using enum JointId;
  constexpr std::array kCollar{Neck, SpineShoulder, ShoulderLeft, ShoulderRight};
  return std::ranges::all_of(kCollar,
                             [&](JointId id) { return body[id].state == JointState::Tracked; });
}

ShoulderSight first_sight(Timestamp instant, double angle, bool tracked) {
  return {instant, angle, !tracked, tracked ? 0.0 : 1.0};
}

ShoulderSight next_sight(const ShoulderSight& before, Timestamp instant, double angle,
                         bool tracked) {
  const double passed = seconds(instant - before.seen);
  if (!(passed >= 0 && passed <= kLongestGap)) return first_sight(instant, angle, tracked);
  ShoulderSight now{instant, angle, before.rear, before.guessed};
  if (std::abs(wrap_angle(angle - before.angle)) > kJump) now.rear = !now.rear;
  now.guessed += passed / (passed + kMemory) * ((tracked ? 0.0 : 1.0) - now.guessed);
  if (std::abs(angle) < kSquare && now.guessed > kMostly) now.rear = true;
  if (std::abs(angle) < kSquare && now.guessed < 1.0 - kMostly) now.rear = false;
  return now;
}

}  // namespace

void resolve_sides_by_shoulders(Person& person, Timestamp instant, ShoulderMemory& memory) {
  for (SensorView& view : person.views) {
    if (!std::isfinite(view.facing)) continue;
    const bool tracked = collar_tracked(view.skeleton);
    const auto [known, fresh] =
        memory.try_emplace({person.id, view.sensor}, first_sight(instant, view.facing, tracked));
    if (!fresh) known->second = next_sight(known->second, instant, view.facing, tracked);
    if (!known->second.rear) continue;
    exchange_sides(view.skeleton);
    view.facing = wrap_angle(view.facing + std::numbers::pi);
  }
}

}  // namespace chorus::facing
