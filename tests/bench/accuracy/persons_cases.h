// The scenes that association is measured in, and who is said to be who in one draw of them, by
// every method.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fusion-server/associate/person_association.h"
#include "tests/judge/identity.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

struct PersonsCase {
  std::string name;
  std::string profile;
  std::vector<Eigen::Isometry3d> places;
  std::vector<synthetic::Person> (*people)(std::uint64_t seed);
  std::vector<synthetic::Occluder> occluders = {};
  Duration length = std::chrono::seconds(30);
  /// Changes the sensor at a place after the draw.
  std::function<void(synthetic::kinect::Profile&, std::size_t place)> adjust = {};
  std::size_t draws = 20;
  bool sides = false;  ///< Is asked for sides_wrong_in() too.
};

/// The one that is measured in quick runs and swept.
inline constexpr const char* kCrossingTwo = "crossing-2";

[[nodiscard]] std::vector<PersonsCase> persons_cases();

/// Association as configured, under a name.
struct Association {
  std::string name;
  associate::AssociationConfig config = {};
};

/// By method.
using Identities = std::map<std::string, Identity>;

/// One draw: each of `ours`, and beside them `nearest-neighbour` (greedy, without prediction) and
/// `best-sensor-ids` (one sensor's own ids at face value, the sensor chosen knowing the truth).
[[nodiscard]] Identities identities_in(const PersonsCase& each, std::uint64_t seed,
                                       const std::vector<Association>& ours);

/// The whole product's perception: share of the instants at which somebody's views together fit
/// them better with left and right exchanged, people who are not answered left out.
[[nodiscard]] double sides_wrong_in(const PersonsCase& each, std::uint64_t seed);

}  // namespace chorus::bench
