// The parameters of a site: times, distances, limits.
#pragma once

#include <cstddef>

#include "common/base/duration.h"
#include "common/base/units.h"

namespace chorus::site {

struct SiteConfig {
  /// Nobody is named, joined or taken over before there is evidence for this long.
  Duration evidence = std::chrono::milliseconds(500);
  /// How long a person waits beyond that for a neighbour who saw them first and is about to name
  /// them, or whose word takes its time.
  Duration wait_for_name = std::chrono::milliseconds(600);
  /// How long a person whom no cell sees can be found again under the same id; 0: not at all.
  Duration remember = std::chrono::seconds(60);
  /// A cell that has said nothing for this long has no say, and whom it held may be claimed.
  Duration lease = std::chrono::seconds(2);
  /// How well a place is known at the least, whatever is stated: standard deviations.
  double place_sigma = 0.05;  ///< [m]
  double yaw_sigma = deg(0.5);
  Duration clock_sigma = std::chrono::milliseconds(10);
  /// What is assumed where nothing is stated.
  double unknown_place_sigma = 0.2;  ///< [m]
  double unknown_yaw_sigma = deg(2);
  Duration unknown_clock_sigma = std::chrono::milliseconds(50);
  /// The least standard deviation of a person's place in one cell, whatever it states [m]: sensors
  /// that see a body from different sides place its joints differently.
  double person_sigma = 0.04;
  /// How long the difference between two cells' bodies of a person fades when another cell answers
  /// for them.  As long as `evidence`: the next hand-over is not sooner.
  Duration blend = std::chrono::milliseconds(500);
  /// Below this certainty a name is stated to be doubtful.
  double doubt = 0.9;
  std::size_t max_people = 64;  ///< A message with more people is refused.
  /// A message whose stamp is farther ahead of our clock is refused.
  Duration max_ahead = std::chrono::seconds(2);
  /// A message that is older than this when it comes is refused.
  Duration max_age = std::chrono::seconds(5);

  bool operator==(const SiteConfig&) const = default;
};

}  // namespace chorus::site
