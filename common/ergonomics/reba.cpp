// REBA: Hignett & McAtamney 2000.
#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/table.h"
#include "common/ergonomics/upper_limb.h"

namespace chorus::ergonomics {
namespace {

namespace reba {

enum : std::size_t {
  kTrunk,
  kNeck,
  kLegs,
  kUpperArm,
  kLowerArm,
  kWrist,
  kTwist,
  kSupport,
  kLoad,
  kShock,
  kGrip,
  kActivity
};

constexpr std::array<Input, 12> kInputs{{
    {"trunk", {"Trunk", "Rumpf"}, Origin::Measured, 1, 5},
    {"neck", {"Neck", "Hals"}, Origin::Measured, 1, 3},
    {"legs", {"Legs", "Beine"}, Origin::Measured, 1, 4},
    {"upperArm", {"Upper arm", "Oberarm"}, Origin::Measured, 1, 6},
    {"lowerArm", {"Lower arm", "Unterarm"}, Origin::Measured, 1, 2},
    {"wrist",
     {"Wrist", "Handgelenk"},
     Origin::Measured,
     1,
     2,
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
    {"load",
     {"Load", "Last"},
     Origin::Asked,
     1,
     3,
     {"the load is under 5 kg", "die Last unter 5 kg ist"}},
    {"shock", {"Shock", "Stoß"}, Origin::Asked, 1, 2, {"there is no shock", "kein Stoß auftritt"}},
    {"coupling",
     {"Coupling", "Griff"},
     Origin::Asked,
     1,
     4,
     {"the grip is good", "der Griff gut ist"}},
    {"activity",
     {"Activity", "Aktivität"},
     Origin::Asked,
     1,
     4,
     {"nothing is static, repeated or unstable", "nichts statisch, wiederholt oder unsicher ist"}},
}};

constexpr std::array<Level, 5> kLevels{{
    {1, "negligible", {"negligible; no action", "vernachlässigbar; kein Handlungsbedarf"}},
    {2, "low", {"low; action may be necessary", "gering; Maßnahmen eventuell nötig"}},
    {4, "medium", {"medium; action necessary", "mittel; Maßnahmen nötig"}},
    {8, "high", {"high; action necessary soon", "hoch; Maßnahmen bald nötig"}},
    {11, "very high", {"very high; action necessary now", "sehr hoch; Maßnahmen sofort nötig"}},
}};

std::int8_t trunk_code(const Seen& seen) {
  const double flexion = seen.measures[Centre::TrunkFlexion];
  if (std::isnan(flexion)) return 0;
  const Limits& limit = limits();
  int code = 1;
  if (std::abs(flexion) > limit.upright) code = 2;
  if (std::abs(flexion) > limit.reba_trunk_low) code = 3;
  if (flexion > limit.reba_trunk_high) code = 4;
  return static_cast<std::int8_t>(
      code + asymmetry(seen.measures[Centre::TrunkTwist], seen.measures[Centre::TrunkSideBend]));
}

std::int8_t neck_code(const Seen& seen) {
  const double flexion = seen.measures[Centre::NeckFlexion];
  if (std::isnan(flexion)) return 0;
  const bool bent = flexion > limits().reba_neck || flexion < -limits().upright;
  return static_cast<std::int8_t>(
      1 + (bent ? 1 : 0) +
      asymmetry(seen.measures[Centre::NeckTwist], seen.measures[Centre::NeckSideBend]));
}

std::int8_t legs_code(const Seen& seen) {
  const auto legs = legs_of(seen);
  if (!legs) return 0;
  if (*legs == Legs::Sitting || *legs == Legs::Walking) return 1;
  const int base = *legs == Legs::OneStraight || *legs == Legs::OneBent ? 2 : 1;
  const double knee = knee_of(seen);
  const int bent = knee > limits().reba_knee_high ? 2 : knee > limits().reba_knee_low ? 1 : 0;
  return static_cast<std::int8_t>(base + bent);
}

std::int8_t wrist_code(const Seen& seen, Side side) {
  const double flexion = seen.measures.at(Limb::WristFlexion, side);
  if (std::isnan(flexion)) return 0;
  return flexion > limits().reba_wrist ? 2 : 1;
}

void measure(const Seen& seen, Side side, Codes& codes) {
  codes[kTrunk] = trunk_code(seen);
  codes[kNeck] = neck_code(seen);
  codes[kLegs] = legs_code(seen);
  codes[kUpperArm] = upper_arm_code(seen, side);
  codes[kLowerArm] = lower_arm_code(seen, side);
  codes[kWrist] = wrist_code(seen, side);
}

std::int8_t flag(const std::optional<bool>& answer, bool raises = true) {
  return !answer ? std::int8_t{0} : *answer == raises ? std::int8_t{2} : std::int8_t{1};
}

void ask(const Asked& asked, Codes& codes) {
  if (asked.wrist == Wrist::Straight) codes[kWrist] = 1;
  if (asked.wrist == Wrist::Bent) codes[kWrist] = 2;
  codes[kTwist] = flag(asked.wrist_twisted);
  codes[kSupport] = flag(asked.arm_supported, false);
  if (asked.load_kg) codes[kLoad] = *asked.load_kg < 5.0 ? 1 : *asked.load_kg <= 10.0 ? 2 : 3;
  codes[kShock] = flag(asked.shock);
  if (asked.coupling)
    codes[kGrip] = static_cast<std::int8_t>(1 + static_cast<int>(*asked.coupling));
  if (asked.held_over_minute && asked.repeated && asked.unstable)
    codes[kActivity] =
        static_cast<std::int8_t>(1 + (*asked.held_over_minute ? 1 : 0) + (*asked.repeated ? 1 : 0) +
                                 (*asked.unstable ? 1 : 0));
}

struct Parts {
  int table_a, score_a, table_b, score_b, score_c, score;
};

Parts parts_of(const Codes& codes) {
  const PrintedTables& tables = printed_tables();
  Parts parts{};
  parts.table_a = tables.reba_a.at(codes[kNeck], codes[kTrunk], codes[kLegs]);
  parts.score_a = parts.table_a + codes[kLoad] - 1 + codes[kShock] - 1;
  const int upper_arm = codes[kUpperArm] - (codes[kSupport] == 1 ? 1 : 0);
  parts.table_b = tables.reba_b.at(codes[kLowerArm], upper_arm, codes[kWrist] + codes[kTwist] - 1);
  parts.score_b = parts.table_b + codes[kGrip] - 1;
  parts.score_c = tables.reba_c.at(parts.score_a, parts.score_b);
  parts.score = parts.score_c + codes[kActivity] - 1;
  return parts;
}

int score(const Codes& codes) { return parts_of(codes).score; }

std::vector<Step> steps(const Codes& codes) {
  const Parts parts = parts_of(codes);
  return {{{"Table A", "Tabelle A"}, parts.table_a}, {{"Score A", "Wert A"}, parts.score_a},
          {{"Table B", "Tabelle B"}, parts.table_b}, {{"Score B", "Wert B"}, parts.score_b},
          {{"Score C", "Wert C"}, parts.score_c},    {{"REBA score", "REBA-Wert"}, parts.score}};
}

}  // namespace reba
}  // namespace

const Method kReba{"reba",
                   {"REBA", "REBA"},
                   "Hignett & McAtamney (2000), Applied Ergonomics 31(2), 201-205",
                   reba::kInputs,
                   reba::kLevels,
                   15,
                   true,
                   true,
                   reba::measure,
                   reba::ask,
                   reba::score,
                   reba::steps};

}  // namespace chorus::ergonomics
