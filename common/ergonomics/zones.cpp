// Zones of ISO 11226 (static postures) and EN 1005-4 (postures and movements at machinery): each
// part of the body is in zone 1 (acceptable), 2 (on a condition: for how long, with what support,
// how often) or 3 (not recommended); the posture is in the worst zone of its parts.
#include <algorithm>
#include <cmath>

#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/limits.h"

namespace chorus::ergonomics {
namespace {

namespace zones {

enum : std::size_t { kTrunk, kSymmetry, kHead, kNeck, kUpperArm, kShoulder };

constexpr std::array<Input, 6> kIsoInputs{{
    {"trunk", {"Trunk inclination", "Rumpfneigung"}, Origin::Measured, 1, 3},
    {"symmetry",
     {"Trunk twisted or bent sideways", "Rumpf verdreht oder seitlich geneigt"},
     Origin::Measured,
     1,
     3},
    {"head", {"Head inclination", "Kopfneigung"}, Origin::Measured, 1, 3},
    {"neck", {"Neck flexion", "Halsbeugung"}, Origin::Measured, 1, 3},
    {"upperArm", {"Upper arm elevation", "Oberarm angehoben"}, Origin::Measured, 1, 3},
    {"shoulder",
     {"Raised shoulder, arm behind", "Schulter hochgezogen, Arm hinten"},
     Origin::Measured,
     1,
     3},
}};
constexpr std::array<Input, 4> kEnInputs{{
    {"trunk", {"Trunk bending", "Rumpfbeugung"}, Origin::Measured, 1, 3},
    {"symmetry",
     {"Trunk twisted or bent sideways", "Rumpf verdreht oder seitlich geneigt"},
     Origin::Measured,
     1,
     3},
    {"head", {"Head and neck", "Kopf und Hals"}, Origin::Measured, 1, 3},
    {"upperArm", {"Upper arms", "Oberarme"}, Origin::Measured, 1, 3},
}};
enum : std::size_t { kEnTrunk, kEnSymmetry, kEnHead, kEnUpperArm };

constexpr std::array<Level, 3> kIsoLevels{{
    {1, "acceptable", {"acceptable", "annehmbar"}},
    {2,
     "on condition",
     {"acceptable for a limited time or with support",
      "annehmbar für begrenzte Zeit oder mit Stütze"}},
    {3, "not recommended", {"not recommended", "nicht empfohlen"}},
}};
constexpr std::array<Level, 3> kEnLevels{{
    {1, "acceptable", {"acceptable", "annehmbar"}},
    {2, "on condition", {"acceptable on conditions", "bedingt annehmbar"}},
    {3,
     "not acceptable",
     {"not acceptable if static or frequent", "statisch oder häufig nicht annehmbar"}},
}};

/// Zone of a value that is good below `low` and bad above `high`; 0 for NaN.
std::int8_t zone(double value, double low, double high) {
  if (std::isnan(value)) return 0;
  return value > high ? std::int8_t{3} : value > low ? std::int8_t{2} : std::int8_t{1};
}

/// Bending forward; backward is `behind`.
std::int8_t forward_zone(double value, double low, double high, std::int8_t behind) {
  return value < -limits().upright ? behind : zone(value, low, high);
}

double larger_arm(const Seen& seen) {
  const double left = seen.measures.at(Limb::UpperArmElevation, Side::Left);
  const double right = seen.measures.at(Limb::UpperArmElevation, Side::Right);
  return std::isnan(left + right) ? std::nan("") : std::max(left, right);
}

double hindmost_arm(const Seen& seen) {
  const double left = seen.measures.at(Limb::UpperArmRaise, Side::Left);
  const double right = seen.measures.at(Limb::UpperArmRaise, Side::Right);
  return std::isnan(left + right) ? std::nan("") : std::min(left, right);
}

std::int8_t symmetry(const Seen& seen, double limit) {
  const auto asymmetric = trunk_asymmetric(seen, limit, limit);
  return !asymmetric ? std::int8_t{0} : *asymmetric ? std::int8_t{3} : std::int8_t{1};
}

std::int8_t shoulder_zone(const Seen& seen) {
  const double behind = hindmost_arm(seen);
  if (std::isnan(behind)) return 0;
  bool raised = false;
  for (const Side side : posture::kSides)
    raised |= seen.measures.at(Limb::ShoulderRaise, side) > limits().shoulder_raised;
  return raised || behind < -limits().iso_upper_arm_low ? std::int8_t{3} : std::int8_t{1};
}

void measure_iso(const Seen& seen, Side, Codes& codes) {
  const Limits& limit = limits();
  codes[kTrunk] = forward_zone(seen.measures[Centre::TrunkFlexion], limit.iso_trunk_low,
                               limit.iso_trunk_high, 3);
  codes[kSymmetry] = symmetry(seen, limit.iso_asymmetric);
  codes[kHead] = forward_zone(seen.measures[Centre::HeadInclination], limit.iso_head_low,
                              limit.iso_head_high, 3);
  codes[kNeck] =
      forward_zone(seen.measures[Centre::NeckFlexion], limit.iso_neck, limit.iso_neck, 3);
  codes[kUpperArm] = zone(larger_arm(seen), limit.iso_upper_arm_low, limit.iso_upper_arm_high);
  codes[kShoulder] = shoulder_zone(seen);
}

void measure_en(const Seen& seen, Side, Codes& codes) {
  const Limits& limit = limits();
  codes[kEnTrunk] =
      forward_zone(seen.measures[Centre::TrunkFlexion], limit.en_trunk_low, limit.en_trunk_high, 2);
  codes[kEnSymmetry] = symmetry(seen, limit.en_asymmetric);
  codes[kEnHead] =
      forward_zone(seen.measures[Centre::HeadInclination], limit.en_head, limit.en_head, 3);
  const std::int8_t raised =
      zone(larger_arm(seen), limit.en_upper_arm_low, limit.en_upper_arm_high);
  codes[kEnUpperArm] = hindmost_arm(seen) < -limit.en_upper_arm_low ? std::int8_t{3} : raised;
}

void ask_nothing(const Asked&, Codes&) {}

int worst(const Codes& codes) { return *std::ranges::max_element(codes); }

std::vector<Step> steps(const Codes& codes) {
  return {{{"Worst zone", "Schlechteste Zone"}, worst(codes)}};
}

}  // namespace zones
}  // namespace

const Method kIso11226{"iso11226",
                       {"ISO 11226 zones", "Zonen nach ISO 11226"},
                       "ISO 11226:2000, Tables 1 to 3",
                       zones::kIsoInputs,
                       zones::kIsoLevels,
                       3,
                       false,
                       true,
                       zones::measure_iso,
                       zones::ask_nothing,
                       zones::worst,
                       zones::steps};
const Method kEn1005{"en1005-4",
                     {"EN 1005-4 zones", "Zonen nach EN 1005-4"},
                     "EN 1005-4:2005+A1:2008, 4.3",
                     zones::kEnInputs,
                     zones::kEnLevels,
                     3,
                     false,
                     true,
                     zones::measure_en,
                     zones::ask_nothing,
                     zones::worst,
                     zones::steps};

}  // namespace chorus::ergonomics
