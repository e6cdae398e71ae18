#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/units.h"
#include "common/ergonomics/all_methods.h"

namespace chorus::ergonomics {
namespace {

using ::testing::HasSubstr;

/// Somebody upright; everything asked is answered with the least.
Seen upright() {
  Seen seen;
  seen.measures.values.fill(0.0);
  for (const Side side : posture::kSides) {
    seen.measures.at(Limb::ElbowFlexion, side) = deg(80);
    seen.measures.at(Limb::HandAboveHead, side) = -0.5;
    seen.measures.at(Limb::KneeHeight, side) = 0.4;
    seen.measures.at(Limb::ForearmAcross, side) = -0.2;
  }
  return seen;
}

Asked nothing() {
  Asked asked;
  asked.load_kg = 0.0;
  asked.coupling = Coupling::Good;
  asked.wrist = Wrist::Straight;
  asked.shock = asked.wrist_twisted = asked.arm_supported = false;
  asked.held_over_minute = asked.repeated = asked.unstable = false;
  return asked;
}

int scored(const Method& method, const Seen& seen, const Asked& asked = nothing()) {
  const auto left = score_of(method, codes_of(method, seen, Side::Left, asked));
  const auto right = score_of(method, codes_of(method, seen, Side::Right, asked));
  const auto both = method.sided ? worse(left, right) : left;
  EXPECT_EQ(both.low, both.high);
  return both.low;
}

TEST(Methods, ScoreAnUprightPersonLowest) {
  for (const Method* method : methods()) {
    if (!method->ordered) continue;
    EXPECT_EQ(scored(*method, upright()), 1) << method->name;
  }
  EXPECT_EQ(scored(kEaws, upright()), 2);
}

// Numbers on the form: "20-60" begins above 20.
TEST(Reba, LimitsAreAsPrinted) {
  const auto code = [](double degrees) {
    Seen seen = upright();
    seen.measures[Centre::TrunkFlexion] = deg(degrees);
    return int{codes_of(kReba, seen, Side::Left, nothing())[0]};
  };
  EXPECT_EQ(code(19.9), 2);
  EXPECT_EQ(code(20.0), 2);
  EXPECT_EQ(code(20.1), 3);
  EXPECT_EQ(code(59.9), 3);
  EXPECT_EQ(code(60.1), 4);
  EXPECT_EQ(code(-19.9), 2);
  EXPECT_EQ(code(-20.1), 3);
}

TEST(Reba, UpperAndLowerArm) {
  const auto codes = [](double raise, double elbow, double abduction = 0.0) {
    Seen seen = upright();
    seen.measures.at(Limb::UpperArmRaise, Side::Right) = deg(raise);
    seen.measures.at(Limb::UpperArmAbduction, Side::Right) = deg(abduction);
    seen.measures.at(Limb::ElbowFlexion, Side::Right) = deg(elbow);
    const auto all = codes_of(kReba, seen, Side::Right, nothing());
    return std::pair<int, int>(all[3], all[4]);
  };
  EXPECT_EQ(codes(20.0, 60.0), std::pair(1, 1));
  EXPECT_EQ(codes(20.1, 59.9), std::pair(2, 2));
  EXPECT_EQ(codes(-21, 100.0), std::pair(2, 1));
  EXPECT_EQ(codes(45.1, 100.1), std::pair(3, 2));
  EXPECT_EQ(codes(90.1, 80), std::pair(4, 1));
  EXPECT_EQ(codes(90.1, 80, 60), std::pair(5, 1));
}

// By hand from the form: trunk 3, neck 1, legs 2: Table A 4; 6 kg: score A 5. Upper arm 3, lower
// arm 2, wrist 1: Table B 4; fair grip: score B 5. Table C (5, 5): 6.
TEST(Reba, AWorkedPosture) {
  Seen seen = upright();
  seen.measures[Centre::TrunkFlexion] = deg(30);
  seen.measures.at(Limb::KneeFlexion, Side::Left) = deg(45);
  seen.measures.at(Limb::UpperArmRaise, Side::Left) = deg(50);
  seen.measures.at(Limb::ElbowFlexion, Side::Left) = deg(20);
  Asked asked = nothing();
  asked.load_kg = 6.0;
  asked.coupling = Coupling::Fair;
  EXPECT_EQ(scored(kReba, seen, asked), 6);
}

TEST(Reba, WhatIsNotAskedMakesARange) {
  Seen seen = upright();
  seen.measures[Centre::TrunkFlexion] = deg(30);
  Asked asked = nothing();
  asked.load_kg.reset();
  const auto codes = codes_of(kReba, seen, Side::Left, asked);
  const auto range = score_of(kReba, codes);
  EXPECT_LT(range.low, range.high);
  const std::string text = range_text(kReba, codes, false);
  EXPECT_THAT(text, HasSubstr(" to "));
  EXPECT_THAT(text, HasSubstr("if the load is under 5 kg"));
  EXPECT_THAT(range_text(kReba, codes, true), HasSubstr("falls die Last unter 5 kg ist"));
}

TEST(Reba, OfSomebodyUnseenIsUnknown) {
  EXPECT_FALSE(score_of(kReba, codes_of(kReba, Seen{}, Side::Left, nothing())).known());
}

TEST(Owas, CodesAsDefined) {
  const auto codes = [](auto change) {
    Seen seen = upright();
    change(seen);
    const auto all = codes_of(kOwas, seen, Side::Left, nothing());
    return 100 * all[0] + 10 * all[1] + all[2];
  };
  const auto knee = [](Seen& seen, double degrees) {
    for (const Side side : posture::kSides)
      seen.measures.at(Limb::KneeFlexion, side) = deg(degrees);
  };
  EXPECT_EQ(codes([](Seen&) {}), 112);
  EXPECT_EQ(codes([](Seen& s) { s.measures[Centre::TrunkFlexion] = deg(20.1); }), 212);
  EXPECT_EQ(codes([](Seen& s) { s.measures[Centre::TrunkTwist] = deg(-21); }), 312);
  EXPECT_EQ(codes([](Seen& s) {
              s.measures[Centre::TrunkFlexion] = deg(40);
              s.measures[Centre::TrunkSideBend] = deg(25);
            }),
            412);
  EXPECT_EQ(codes([](Seen& s) { s.measures.at(Limb::UpperArmElevation, Side::Right) = deg(90); }),
            122);
  EXPECT_EQ(codes([&](Seen& s) { knee(s, 40); }), 114);
  EXPECT_EQ(codes([](Seen& s) { s.measures.at(Limb::FootLift, Side::Left) = 0.2; }), 113);
  EXPECT_EQ(codes([](Seen& s) { s.walking = true; }), 117);
  EXPECT_EQ(codes([&](Seen& s) {
              knee(s, 90);
              for (const Side side : posture::kSides)
                s.measures.at(Limb::ThighInclination, side) = deg(85);
            }),
            111);
  EXPECT_EQ(codes([](Seen& s) {
              s.measures.at(Limb::KneeHeight, Side::Left) = 0.02;
              s.measures.at(Limb::ShankInclination, Side::Left) = deg(85);
            }),
            116);
}

TEST(Zones, OfTheStandardsAreAsPrinted) {
  const auto zone = [](const Method& method, double trunk) {
    Seen seen = upright();
    seen.measures[Centre::TrunkFlexion] = deg(trunk);
    return scored(method, seen);
  };
  for (const Method* method : {&kIso11226, &kEn1005}) {
    EXPECT_EQ(zone(*method, 19.9), 1);
    EXPECT_EQ(zone(*method, 20.1), 2);
    EXPECT_EQ(zone(*method, 60.1), 3);
  }
  EXPECT_EQ(zone(kIso11226, -10), 3);
  EXPECT_EQ(zone(kEn1005, -10), 2);
}

TEST(EawsClasses, BendingGoesBeforeArms) {
  Seen seen = upright();
  seen.measures.at(Limb::UpperArmElevation, Side::Left) = deg(100);
  EXPECT_EQ(scored(kEaws, seen), 5);
  seen.measures.at(Limb::HandAboveHead, Side::Left) = 0.1;
  EXPECT_EQ(scored(kEaws, seen), 6);
  seen.measures[Centre::TrunkFlexion] = deg(70);
  EXPECT_EQ(scored(kEaws, seen), 4);
}

TEST(FindingMethods, NamesTheNearest) {
  EXPECT_THAT(find_method("rebba").error().message, HasSubstr("did you mean reba?"));
  EXPECT_THAT(find_methods("reba,reba").error().message, HasSubstr("twice"));
  EXPECT_EQ(find_methods("reba,owas")->size(), 2u);
}

/// A body drawn anywhere; legs stand, so that their class stays.
Seen drawn(std::mt19937_64& random) {
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random() >> 11U) / 9007199254740992.0;
  };
  Seen seen = upright();
  for (std::size_t m = 0; m < posture::kMeasures; ++m) {
    if (posture::row_of(m).unit == posture::Unit::Angle)
      seen.measures.values[m] = uniform(deg(-40), deg(120));
  }
  for (const Side side : posture::kSides) {
    seen.measures.at(Limb::KneeFlexion, side) = uniform(0, deg(80));
    seen.measures.at(Limb::ThighInclination, side) = deg(10);
    seen.measures.at(Limb::ShankInclination, side) = deg(10);
  }
  return seen;
}

/// Moving one of these away from zero never lowers an ordered score.  (Elbows have no neutral angle
/// but a neutral range, thighs and shanks decide who sits.)
TEST(Laws, NoScoreFallsWhenAnAngleMovesAwayFromNeutral) {
  using posture::index_of;
  std::mt19937_64 random(11);
  for (int n = 0; n < 500; ++n) {
    const Seen seen = drawn(random);
    for (const std::size_t m :
         {index_of(Centre::TrunkFlexion), index_of(Centre::TrunkSideBend),
          index_of(Centre::TrunkTwist), index_of(Centre::NeckSideBend), index_of(Centre::NeckTwist),
          index_of(Limb::UpperArmElevation, Side::Left),
          index_of(Limb::UpperArmAbduction, Side::Right),
          index_of(Limb::KneeFlexion, Side::Left)}) {
      Seen farther = seen;
      farther.measures.values[m] *= 1.3;
      for (const Method* method : methods()) {
        if (!method->ordered) continue;
        EXPECT_LE(scored(*method, seen), scored(*method, farther))
            << method->name << " " << posture::name_of(m);
      }
    }
  }
}

TEST(Laws, ScoresAreMirrorSymmetric) {
  std::mt19937_64 random(12);
  for (int n = 0; n < 500; ++n) {
    const Seen seen = drawn(random);
    Seen mirrored = seen;
    for (const Centre flips :
         {Centre::TrunkSideBend, Centre::TrunkTwist, Centre::NeckSideBend, Centre::NeckTwist})
      mirrored.measures[flips] *= -1.0;
    for (std::size_t l = 0; l < posture::kLimbs; ++l)
      std::swap(mirrored.measures.at(static_cast<Limb>(l), Side::Left),
                mirrored.measures.at(static_cast<Limb>(l), Side::Right));
    for (const Method* method : methods())
      EXPECT_EQ(scored(*method, seen), scored(*method, mirrored));
  }
}

}  // namespace
}  // namespace chorus::ergonomics
