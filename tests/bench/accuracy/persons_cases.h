// The scenes in which association is measured, and how well each method keeps people's identities
// in one draw of them.
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
  /// Changes the profile of the sensor at `place` after the draw.
  std::function<void(synthetic::kinect::Profile&, std::size_t place)> adjust = {};
  std::size_t draws = 20;
  bool sides = false;  ///< True: sides_wrong_in() is measured, too.
  /// Changes what the sensors have recorded.
  void (*distort)(Workshop& workshop) = nullptr;
};

/// The case for which the share of draws without a change of id is checked.
inline constexpr const char* kCrossingTwo = "crossing-2";

[[nodiscard]] std::vector<PersonsCase> persons_cases();

/// A named configuration of association.
struct Association {
  std::string name;
  associate::AssociationConfig config = {};
};

/// The scores of each method, by its name.
using Identities = std::map<std::string, Identity>;

/// The scores in one draw of each of `ours`, and in addition of `nearest-neighbour` (greedy,
/// without prediction) and `best-sensor-ids` (the ids of one sensor as they are; the truth decides
/// which sensor is best).
[[nodiscard]] Identities identities_in(const PersonsCase& each, std::uint64_t seed,
                                       const std::vector<Association>& ours);

/// Runs the product's whole perception; returns the fraction of the instants at which a person's
/// views together fit better with left and right swapped.  People who are not reported are left
/// out.
[[nodiscard]] double sides_wrong_in(const PersonsCase& each, std::uint64_t seed);

}  // namespace chorus::bench
