// RULA: McAtamney & Corlett 1993.
#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/table.h"
#include "common/ergonomics/upper_limb.h"

namespace chorus::ergonomics {
namespace {

namespace rula {

enum : std::size_t {
  kUpperArm,
  kLowerArm,
  kWrist,
  kTwist,
  kSupport,
  kNeck,
  kTrunk,
  kLegs,
  kMuscle,
  kForce
};

constexpr std::array<Input, 10> kInputs{{
    {"upperArm", {"Upper arm", "Oberarm"}, Origin::Measured, 1, 6},
    {"lowerArm", {"Lower arm", "Unterarm"}, Origin::Measured, 1, 3},
    {"wrist",
     {"Wrist", "Handgelenk"},
     Origin::Measured,
     1,
     3,
     {"the wrist is straight", "das Handgelenk gerade ist"}},
    {"wristTwist",
     {"Wrist twisted or deviated", "Handgelenk gedreht oder abgeknickt"},
     Origin::Asked,
     1,
     2,
     {"the wrist is not twisted", "das Handgelenk nicht gedreht ist"}},
    {"support",
     {"Arm supported or leaning", "Arm gestützt oder angelehnt"},
     Origin::Asked,
     1,
     2,
     {"the arm is supported", "der Arm gestützt ist"}},
    {"neck", {"Neck", "Hals"}, Origin::Measured, 1, 6},
    {"trunk", {"Trunk", "Rumpf"}, Origin::Measured, 1, 6},
    {"legs", {"Legs", "Beine"}, Origin::Measured, 1, 2},
    {"muscle",
     {"Muscle use", "Muskelarbeit"},
     Origin::Asked,
     1,
     2,
     {"nothing is static or repeated", "nichts statisch oder wiederholt ist"}},
    {"force",
     {"Force", "Kraft"},
     Origin::Asked,
     1,
     4,
     {"the load is under 2 kg", "die Last unter 2 kg ist"}},
}};

constexpr std::array<Level, 4> kLevels{{
    {1, "acceptable", {"acceptable", "annehmbar"}},
    {3, "investigate", {"investigate further", "weiter untersuchen"}},
    {5, "change soon", {"change soon", "bald ändern"}},
    {7, "change now", {"change now", "sofort ändern"}},
}};

std::int8_t lower_arm(const Seen& seen, Side side) {
  const std::int8_t base = lower_arm_code(seen, side);
  if (base == 0) return 0;
  const bool across = seen.measures.at(Limb::ForearmAcross, side) > limits().across;
  const bool out = seen.measures.at(Limb::ForearmOut, side) > limits().out;
  return static_cast<std::int8_t>(base + (across || out ? 1 : 0));
}

std::int8_t wrist_code(const Seen& seen, Side side) {
  const double flexion = seen.measures.at(Limb::WristFlexion, side);
  if (std::isnan(flexion)) return 0;
  return flexion > limits().rula_wrist ? 3 : flexion > limits().upright ? 2 : 1;
}

std::int8_t neck_code(const Seen& seen) {
  const double flexion = seen.measures[Centre::NeckFlexion];
  if (std::isnan(flexion)) return 0;
  const Limits& limit = limits();
  int code = 1;
  if (flexion > limit.rula_neck_low) code = 2;
  if (flexion > limit.rula_neck_high) code = 3;
  if (flexion < -limit.upright) code = 4;
  return static_cast<std::int8_t>(code + asymmetry(seen.measures[Centre::NeckTwist], 0.0) +
                                  asymmetry(0.0, seen.measures[Centre::NeckSideBend]));
}

std::int8_t trunk_code(const Seen& seen) {
  const double flexion = std::abs(seen.measures[Centre::TrunkFlexion]);
  if (std::isnan(flexion)) return 0;
  const Limits& limit = limits();
  int code = 1;
  if (flexion > limit.upright) code = 2;
  if (flexion > limit.rula_trunk_low) code = 3;
  if (flexion > limit.rula_trunk_high) code = 4;
  return static_cast<std::int8_t>(code + asymmetry(seen.measures[Centre::TrunkTwist], 0.0) +
                                  asymmetry(0.0, seen.measures[Centre::TrunkSideBend]));
}

/// 1: legs and feet well supported and balanced.
std::int8_t legs_code(const Seen& seen) {
  const auto legs = legs_of(seen);
  if (!legs) return 0;
  return *legs == Legs::Sitting || *legs == Legs::Straight || *legs == Legs::Walking ? 1 : 2;
}

void measure(const Seen& seen, Side side, Codes& codes) {
  codes[kUpperArm] = upper_arm_code(seen, side);
  codes[kLowerArm] = lower_arm(seen, side);
  codes[kWrist] = wrist_code(seen, side);
  codes[kNeck] = neck_code(seen);
  codes[kTrunk] = trunk_code(seen);
  codes[kLegs] = legs_code(seen);
}

/// 0: below 2 kg, intermittent. 1: to 10 kg, intermittent. 2: to 10 kg static or repeated, or more.
/// 3: more and static or repeated, or shock.
std::int8_t force_code(const Asked& asked) {
  if (asked.shock == true) return 4;
  if (!asked.load_kg || !asked.shock) return 0;
  if (*asked.load_kg < 2.0) return 1;
  if (!asked.held_over_minute || !asked.repeated) return 0;
  const bool lasting = *asked.held_over_minute || *asked.repeated;
  if (*asked.load_kg <= 10.0) return lasting ? 3 : 2;
  return lasting ? 4 : 3;
}

void ask(const Asked& asked, Codes& codes) {
  if (asked.wrist == Wrist::Straight) codes[kWrist] = 1;
  if (asked.wrist == Wrist::Bent) codes[kWrist] = 3;
  if (asked.wrist_twisted) codes[kTwist] = *asked.wrist_twisted ? 2 : 1;
  if (asked.arm_supported) codes[kSupport] = *asked.arm_supported ? 1 : 2;
  if (asked.held_over_minute && asked.repeated)
    codes[kMuscle] = *asked.held_over_minute || *asked.repeated ? 2 : 1;
  codes[kForce] = force_code(asked);
}

struct Parts {
  int table_a, score_a, table_b, score_b, score;
};

Parts parts_of(const Codes& codes) {
  const PrintedTables& tables = printed_tables();
  const int added = codes[kMuscle] - 1 + codes[kForce] - 1;
  const int upper_arm = codes[kUpperArm] - (codes[kSupport] == 1 ? 1 : 0);
  const int wrist = codes[kWrist] + (codes[kTwist] == 2 ? 1 : 0);
  Parts parts{};
  parts.table_a = tables.rula_a.at(upper_arm, codes[kLowerArm], wrist, codes[kTwist]);
  parts.score_a = parts.table_a + added;
  parts.table_b = tables.rula_b.at(codes[kNeck], codes[kTrunk], codes[kLegs]);
  parts.score_b = parts.table_b + added;
  parts.score = tables.rula_c.at(parts.score_a, parts.score_b);
  return parts;
}

int score(const Codes& codes) { return parts_of(codes).score; }

std::vector<Step> steps(const Codes& codes) {
  const Parts parts = parts_of(codes);
  return {{{"Table A", "Tabelle A"}, parts.table_a},
          {{"Score C", "Wert C"}, parts.score_a},
          {{"Table B", "Tabelle B"}, parts.table_b},
          {{"Score D", "Wert D"}, parts.score_b},
          {{"Grand score", "Gesamtwert"}, parts.score}};
}

}  // namespace rula
}  // namespace

const Method kRula{"rula",
                   {"RULA", "RULA"},
                   "McAtamney & Corlett (1993), Applied Ergonomics 24(2), 91-99",
                   rula::kInputs,
                   rula::kLevels,
                   7,
                   true,
                   true,
                   rula::measure,
                   rula::ask,
                   rula::score,
                   rula::steps};

}  // namespace chorus::ergonomics
