// OWAS: Karhu, Kansi & Kuorinka 1977; Louhevaara & Suurnaekki 1992.
#include <cmath>

#include "common/ergonomics/all_methods.h"
#include "common/ergonomics/limits.h"
#include "common/ergonomics/table.h"

namespace chorus::ergonomics {
namespace {

namespace owas {

enum : std::size_t { kBack, kArms, kLegs, kLoad };

constexpr std::array<Input, 4> kInputs{{
    {"back", {"Back", "Rücken"}, Origin::Measured, 1, 4},
    {"arms", {"Arms", "Arme"}, Origin::Measured, 1, 3},
    {"legs", {"Legs", "Beine"}, Origin::Measured, 1, 7},
    {"load",
     {"Load", "Last"},
     Origin::Asked,
     1,
     3,
     {"the load is under 10 kg", "die Last unter 10 kg ist"}},
}};

constexpr std::array<Level, 4> kLevels{{
    {1, "normal", {"normal; no action", "normal; kein Handlungsbedarf"}},
    {2,
     "slightly harmful",
     {"slightly harmful; action in the near future",
      "leicht schädlich; Maßnahmen in nächster Zeit"}},
    {3,
     "harmful",
     {"harmful; action as soon as possible", "schädlich; Maßnahmen so bald wie möglich"}},
    {4, "very harmful", {"very harmful; action at once", "sehr schädlich; Maßnahmen sofort"}},
}};

void measure(const Seen& seen, Side, Codes& codes) {
  const Limits& limit = limits();
  const double flexion = seen.measures[Centre::TrunkFlexion];
  const auto twisted = trunk_asymmetric(seen, limit.owas_twisted, limit.owas_twisted);
  if (!std::isnan(flexion) && twisted)
    codes[kBack] = static_cast<std::int8_t>(1 + (std::abs(flexion) > limit.owas_bent ? 1 : 0) +
                                            (*twisted ? 2 : 0));
  const double left = seen.measures.at(Limb::UpperArmElevation, Side::Left);
  const double right = seen.measures.at(Limb::UpperArmElevation, Side::Right);
  if (!std::isnan(left + right))
    codes[kArms] = static_cast<std::int8_t>(1 + (left >= limit.owas_arm_at_least ? 1 : 0) +
                                            (right >= limit.owas_arm_at_least ? 1 : 0));
  if (const auto legs = legs_of(seen)) codes[kLegs] = static_cast<std::int8_t>(*legs);
}

void ask(const Asked& asked, Codes& codes) {
  if (asked.load_kg) codes[kLoad] = *asked.load_kg < 10.0 ? 1 : *asked.load_kg <= 20.0 ? 2 : 3;
}

int score(const Codes& codes) {
  return printed_tables().owas.at(codes[kBack], codes[kArms], codes[kLegs], codes[kLoad]);
}

std::vector<Step> steps(const Codes& codes) {
  const int code = 1000 * codes[kBack] + 100 * codes[kArms] + 10 * codes[kLegs] + codes[kLoad];
  return {{{"Posture code", "Haltungscode"}, code},
          {{"Action category", "Maßnahmenklasse"}, score(codes)}};
}

}  // namespace owas
}  // namespace

const Method kOwas{"owas",
                   {"OWAS", "OWAS"},
                   "Karhu, Kansi & Kuorinka (1977), Applied Ergonomics 8(4), 199-201; Louhevaara & "
                   "Suurnaekki (1992)",
                   owas::kInputs,
                   owas::kLevels,
                   4,
                   false,
                   true,
                   owas::measure,
                   owas::ask,
                   owas::score,
                   owas::steps};

}  // namespace chorus::ergonomics
