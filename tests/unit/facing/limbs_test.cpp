#include "fusion-server/facing/limbs.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/facing/posed_body.h"

namespace chorus::facing {
namespace {

using enum JointId;

const auto kExact = body_at({0, 0, 0}, 0, kAtWork);

Skeleton<WorldSpace> with_exchanged(const std::vector<JointId>& lefts) {
  auto body = kExact;
  for (const JointId left : lefts) std::swap(body[left], body[mirror(left)]);
  return body;
}

Person seen_as(const std::vector<Skeleton<WorldSpace>>& bodies) {
  Person person{PersonId{1}, {}};
  for (std::size_t i = 0; i < bodies.size(); ++i)
    person.views.push_back(
        view_from(static_cast<int>(i), deg(60) * static_cast<double>(i), bodies[i]));
  return person;
}

double off(const Skeleton<WorldSpace>& body, JointId id) {
  return (body[id].position - kExact[id].position).norm();
}

TEST(Limbs, ExchangedInOneOfThreeViewsAreMended) {
  const std::vector<JointId> arms{ShoulderLeft, ElbowLeft,   WristLeft,
                                  HandLeft,     HandTipLeft, ThumbLeft};
  const std::vector<JointId> legs{HipLeft, KneeLeft, AnkleLeft, FootLeft};
  const std::vector<JointId> hands{WristLeft, HandLeft, HandTipLeft, ThumbLeft};
  for (const auto& limb : {arms, legs, hands}) {
    Person person = seen_as({kExact, with_exchanged(limb), kExact});
    mend_limbs(person, spans_of(kExact), {});
    for (const JointId left : limb) {
      EXPECT_LT(off(person.views[1].skeleton, left), 1e-9) << name_of(left);
      EXPECT_LT(off(person.views[0].skeleton, left), 1e-9) << name_of(left);
    }
  }
}

TEST(Limbs, ThatTrulyCrossAreLeftAlone) {
  const auto crossed = with_exchanged({WristLeft, HandLeft, HandTipLeft, ThumbLeft});
  Person person = seen_as({crossed, crossed, crossed});
  mend_limbs(person, spans_of(kExact), {});
  for (const SensorView& view : person.views) {
    EXPECT_GT(off(view.skeleton, WristLeft), 0.3);
    EXPECT_EQ(view.skeleton[WristLeft].state, JointState::Tracked);
  }
}

TEST(Limbs, ThatOnlyContradictWhatWasAgreedCountAsGuessed) {
  Person person = seen_as({with_exchanged({WristLeft, HandLeft})});
  mend_limbs(person, spans_of(kExact), {});
  EXPECT_EQ(person.views[0].skeleton[WristLeft].state, JointState::Inferred);
  EXPECT_EQ(person.views[0].skeleton[ElbowLeft].state, JointState::Tracked);
}

TEST(Limbs, AreNotExchangedForOneJointThatIsFarOff) {
  auto thrown = kExact;
  thrown[WristLeft].position += Eigen::Vector3d(-0.7, 0.2, 0);
  Person person = seen_as({kExact, thrown, kExact});
  mend_limbs(person, spans_of(kExact), {});
  EXPECT_LT(off(person.views[1].skeleton, WristRight), 1e-9);
}

TEST(Limbs, AreLeftAloneWhenNotAskedFor) {
  Person person = seen_as({kExact, with_exchanged({WristLeft}), kExact});
  mend_limbs(person, spans_of(kExact), {.mend = false});
  EXPECT_GT(off(person.views[1].skeleton, WristLeft), 0.3);
}

}  // namespace
}  // namespace chorus::facing
