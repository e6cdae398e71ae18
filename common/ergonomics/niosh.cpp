#include "common/ergonomics/niosh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/base/units.h"
#include "common/ergonomics/table.h"

namespace chorus::ergonomics {
namespace {

constexpr double kLoadConstant = 23.0;  // [kg]
constexpr double kLowHands = 0.75;      // [m]
/// Lifts a minute of the table's rows; between rows the equation is linear.
constexpr std::array kRates{0.2, 0.5, 1.0, 2.0,  3.0,  4.0,  5.0,  6.0,  7.0,
                            8.0, 9.0, 10., 11.0, 12.0, 13.0, 14.0, 15.0, 15.01};

double in_hundredths(int value) { return 0.01 * value; }

double frequency_multiplier(const Lift& lift) {
  if (!(lift.hours > 0.0) || lift.hours > 8.0 || !(lift.per_minute >= 0.0)) return 0.0;
  const int duration = lift.hours <= 1.0 ? 1 : lift.hours <= 2.0 ? 2 : 3;
  const int height = lift.vertical < kLowHands ? 1 : 2;
  const Table& table = printed_tables().niosh_frequency;
  const auto at = [&](std::size_t row) {
    return in_hundredths(table.at(static_cast<int>(row) + 1, duration, height));
  };
  if (lift.per_minute <= kRates.front()) return at(0);
  const auto above = std::ranges::lower_bound(kRates, lift.per_minute);
  if (above == kRates.end()) return 0.0;
  const auto row = static_cast<std::size_t>(above - kRates.begin());
  const double share = (lift.per_minute - kRates[row - 1]) / (kRates[row] - kRates[row - 1]);
  return (1.0 - share) * at(row - 1) + share * at(row);
}

double within(double value, double most, double multiplier) {
  return value <= most ? std::clamp(multiplier, 0.0, 1.0) : 0.0;  // NaN: 0
}

}  // namespace

LiftLimit lift_limit(const Lift& lift) {
  LiftLimit limit;
  limit.hm = within(lift.horizontal, 0.63, 0.25 / std::max(lift.horizontal, 0.25));
  limit.vm = lift.vertical >= 0.0
                 ? within(lift.vertical, 1.75, 1.0 - 0.3 * std::abs(lift.vertical - kLowHands))
                 : 0.0;
  limit.dm = within(lift.distance, 1.75, 0.82 + 0.045 / std::max(lift.distance, 0.25));
  const double degrees = to_deg(std::abs(lift.asymmetry));
  limit.am = within(degrees, 135.0, 1.0 - 0.0032 * degrees);
  limit.fm = frequency_multiplier(lift);
  const int height = lift.vertical < kLowHands ? 1 : 2;
  limit.cm = lift.coupling == Coupling::Unacceptable
                 ? 0.0
                 : in_hundredths(printed_tables().niosh_coupling.at(
                       1 + static_cast<int>(lift.coupling), height));
  limit.weight_kg = kLoadConstant * limit.hm * limit.vm * limit.dm * limit.am * limit.fm * limit.cm;
  return limit;
}

double lifting_index(double load_kg, const LiftLimit& limit) {
  if (limit.weight_kg > 0.0) return load_kg / limit.weight_kg;
  return std::numeric_limits<double>::infinity();
}

}  // namespace chorus::ergonomics
