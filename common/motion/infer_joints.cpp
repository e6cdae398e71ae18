#include "common/motion/infer_joints.h"

namespace chorus::motion {
namespace {

/// A joint at `from + share * (to - from)`; a share above 1 extends a bone.
struct Guess {
  JointId joint;
  JointId from;
  JointId to;
  double share;
};

// In this order, because later ones use earlier ones.  Of the forearm, a palm is 0.25 and the
// finger tips are 0.55 beyond the wrist.
constexpr Guess kGuesses[] = {
    {JointId::SpineBase, JointId::HipLeft, JointId::HipRight, 0.5},
    {JointId::SpineShoulder, JointId::ShoulderLeft, JointId::ShoulderRight, 0.5},
    {JointId::Neck, JointId::SpineShoulder, JointId::Head, 0.5},
    {JointId::SpineMid, JointId::SpineBase, JointId::SpineShoulder, 0.5},
    {JointId::HandLeft, JointId::ElbowLeft, JointId::WristLeft, 1.25},
    {JointId::HandRight, JointId::ElbowRight, JointId::WristRight, 1.25},
    {JointId::HandTipLeft, JointId::ElbowLeft, JointId::WristLeft, 1.55},
    {JointId::HandTipRight, JointId::ElbowRight, JointId::WristRight, 1.55},
};

}  // namespace

void infer_absent(Skeleton<WorldSpace>& body, const JointsThere& there) {
  for (const Guess& guess : kGuesses) {
    const Joint& from = body[guess.from];
    const Joint& to = body[guess.to];
    if (there[index_of(guess.joint)] || !from.seen() || !to.seen()) continue;
    body[guess.joint].position = from.position + guess.share * (to.position - from.position);
    body[guess.joint].state = JointState::Inferred;
  }
}

}  // namespace chorus::motion
