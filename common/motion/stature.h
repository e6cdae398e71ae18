// How tall the people of a motion are: judges the unit of lengths, which files state wrongly or not
// at all.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "common/body/skeleton.h"

namespace chorus::motion {

/// A body's height [m] from the lengths of its legs, arms or trunk, by the proportions of Drillis
/// and Contini (1966): thigh 0.245, shin 0.246, upper arm 0.186 and forearm 0.146 of the height,
/// hips to head 0.39.  None if no two neighbours are seen.
template <class Space>
[[nodiscard]] std::optional<double> stature_of(const Skeleton<Space>& body);

/// People between a toddler and the tallest are this tall [m].
inline constexpr double kShortestPerson = 0.8;
inline constexpr double kTallestPerson = 2.5;

[[nodiscard]] inline bool is_of_a_person(double stature) {
  return stature >= kShortestPerson && stature <= kTallestPerson;
}

struct UnitGuess {
  std::string name;  ///< What --unit takes: "in", "0.0564".
  double metres = 1.0;
  bool named = true;  ///< False: no usual unit fits, and the factor makes a person of 1.7 m.
};

/// The unit that would fit, if people are `stature` tall in units of `metres`: of cm, m, mm,
/// inches, and that of the CMU library as BVH (1 / 0.45 inches) the one that makes them nearest
/// to 1.7 m.
[[nodiscard]] UnitGuess fitting_unit(double stature, double metres);

}  // namespace chorus::motion
