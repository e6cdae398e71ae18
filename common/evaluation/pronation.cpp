#include "common/evaluation/pronation.h"

#include <cmath>

#include "common/base/units.h"
#include "common/evaluation/limb_frame.h"
#include "common/geometry/rotation.h"

namespace chorus::evaluation {
namespace {

using inertial::Limb;

constexpr double kMostPronation = deg(150.0);  // beyond what wrists do: axes of another convention

std::optional<Limb> hand_of(Limb limb) {
  if (limb == Limb::ForearmLeft) return Limb::HandLeft;
  if (limb == Limb::ForearmRight) return Limb::HandRight;
  return std::nullopt;
}

}  // namespace

Eigen::Quaterniond forearm_at_sensor(const Eigen::Quaterniond& world_from_forearm,
                                     const Eigen::Quaterniond& world_from_hand,
                                     const Eigen::Vector3d& bone) {
  const Eigen::Quaterniond hand = world_from_forearm.conjugate() * world_from_hand;
  const double turn = wrap_angle(2.0 * std::atan2(hand.vec().dot(bone), hand.w()));
  if (!(std::abs(turn) <= kMostPronation)) return world_from_forearm;
  return world_from_forearm * exp_map(kPronationShare * turn * bone);
}

std::optional<TrackedOrientation> limb_under_sensor(const Skeleton<WorldSpace>& body, Limb limb) {
  auto out = limb_from_orientation(body, limb);
  const auto hand = hand_of(limb);
  if (!out || !hand) return out;
  if (const auto turned = limb_from_orientation(body, *hand))
    out->world_from_limb = forearm_at_sensor(out->world_from_limb, turned->world_from_limb);
  return out;
}

}  // namespace chorus::evaluation
