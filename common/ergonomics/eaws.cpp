// EAWS-like screening, section 1: classes of postures, whose seconds per minute are counted.  The
// points of the sheet are protected; whoever has it fills a file with them (task.h).
#include <algorithm>
#include <cmath>

#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/limits.h"

namespace chorus::ergonomics {
namespace {

namespace eaws {

enum : std::size_t { kBase, kTrunk, kArms };

constexpr std::array<Input, 3> kInputs{{
    {"base", {"Standing, sitting, kneeling", "Stehen, Sitzen, Knien"}, Origin::Measured, 1, 4},
    {"trunk", {"Trunk", "Rumpf"}, Origin::Measured, 1, 3},
    {"arms", {"Arms", "Arme"}, Origin::Measured, 1, 3},
}};

constexpr std::array<Level, 13> kLevels{{
    {1, "walking", {"standing and walking in turn", "Stehen und Gehen im Wechsel"}},
    {2, "standing", {"standing upright", "aufrecht stehend"}},
    {3, "bent", {"bent forward, 20 to 60 degrees", "vorgebeugt, 20 bis 60 Grad"}},
    {4, "strongly bent", {"strongly bent, over 60 degrees", "stark gebeugt, über 60 Grad"}},
    {5,
     "elbow at shoulder",
     {"upright, elbow at or above the shoulder",
      "aufrecht, Ellenbogen auf oder über Schulterhöhe"}},
    {6, "hands above head", {"upright, hands above the head", "aufrecht, Hände über Kopf"}},
    {7, "sitting", {"sitting upright", "aufrecht sitzend"}},
    {8, "sitting bent", {"sitting, bent forward", "sitzend, vorgebeugt"}},
    {9,
     "sitting, elbow at shoulder",
     {"sitting, elbow at or above the shoulder", "sitzend, Ellenbogen auf oder über Schulterhöhe"}},
    {10,
     "sitting, hands above head",
     {"sitting, hands above the head", "sitzend, Hände über Kopf"}},
    {11, "kneeling", {"kneeling or squatting, upright", "kniend oder hockend, aufrecht"}},
    {12,
     "kneeling bent",
     {"kneeling or squatting, bent forward", "kniend oder hockend, vorgebeugt"}},
    {13,
     "kneeling, elbow at shoulder",
     {"kneeling or squatting, elbow at or above the shoulder",
      "kniend oder hockend, Ellenbogen auf oder über Schulterhöhe"}},
}};

enum Base : std::int8_t { kUnknown, kWalking, kStanding, kSitting, kKneeling };

std::int8_t base_of(const Seen& seen) {
  const auto legs = legs_of(seen);
  if (!legs) return kUnknown;
  if (*legs == Legs::Walking) return kWalking;
  if (*legs == Legs::Sitting) return kSitting;
  if (*legs == Legs::Kneeling) return kKneeling;
  const bool squats = *legs == Legs::Bent && knee_of(seen) > limits().reba_knee_high &&
                      seen.measures.at(Limb::ThighInclination, Side::Left) > limits().thigh_level &&
                      seen.measures.at(Limb::ThighInclination, Side::Right) > limits().thigh_level;
  return squats ? kKneeling : kStanding;
}

void measure(const Seen& seen, Side, Codes& codes) {
  const Limits& limit = limits();
  codes[kBase] = base_of(seen);
  const double flexion = seen.measures[Centre::TrunkFlexion];
  if (!std::isnan(flexion))
    codes[kTrunk] = flexion > limit.eaws_strongly_bent ? 3 : flexion > limit.eaws_bent ? 2 : 1;
  int arms = 0;
  for (const Side side : posture::kSides) {
    const double elevation = seen.measures.at(Limb::UpperArmElevation, side);
    if (std::isnan(elevation)) continue;
    const bool over = seen.measures.at(Limb::HandAboveHead, side) > 0.0;
    arms = std::max(arms, elevation < limit.eaws_elbow_at_least ? 1 : over ? 3 : 2);
  }
  codes[kArms] = static_cast<std::int8_t>(arms);
}

void ask_nothing(const Asked&, Codes&) {}

/// Bending goes before arms, as the sheet's lines for raised arms are "upright".
int score(const Codes& codes) {
  const int trunk = codes[kTrunk];
  const int arms = codes[kArms];
  switch (codes[kBase]) {
    case kSitting:
      return trunk > 1 ? 8 : 7 + (arms > 1 ? arms : 0);
    case kKneeling:
      return trunk > 1 ? 12 : arms > 1 ? 13 : 11;
    default:
      if (trunk > 1) return trunk + 1;
      return arms > 1 ? 3 + arms : codes[kBase] == kWalking ? 1 : 2;
  }
}

std::vector<Step> steps(const Codes& codes) { return {{{"Class", "Klasse"}, score(codes)}}; }

}  // namespace eaws
}  // namespace

const Method kEaws{"eaws-like",
                   {"EAWS-like posture classes", "Haltungsklassen in der Art von EAWS"},
                   "after section 1 of EAWS (Schaub et al. 2013); a screening, not the sheet",
                   eaws::kInputs,
                   eaws::kLevels,
                   13,
                   false,
                   false,
                   eaws::measure,
                   eaws::ask_nothing,
                   eaws::score,
                   eaws::steps};

}  // namespace chorus::ergonomics
