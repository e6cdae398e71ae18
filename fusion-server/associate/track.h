// What association remembers of people between two instants.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/body/bones.h"
#include "fusion-server/associate/build.h"

namespace chorus::associate {

/// A sensor's body at an instant, from which motion is computed.
struct Footprint {
  SensorId sensor;
  BodyId body;
  std::array<std::optional<Eigen::Vector3d>, kCoreJoints.size()> core;  ///< World [m].
};

/// What is remembered of one person.
struct Track {
  PersonId id;
  Timestamp found;                                     ///< First instant with a view.
  Timestamp seen;                                      ///< Last instant with a view of it.
  int hits = 0;                                        ///< Number of instants with a view.
  Eigen::Vector3d core = Eigen::Vector3d::Zero();      ///< Mean of the core joints, world [m].
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< [m/s]
  std::vector<Footprint> footprints = {};              ///< At the instant when it was last seen.
  int shadowed = 0;  ///< Consecutive instants on an older track's spot without a common sensor.
  Located joints;    ///< Where its joints were then; known while cameras show rays.
  bool admitted = false;  ///< It may be published; once admitted, always.
  bool doubted = false;   ///< Another sensor looked at its place and saw nobody.
  Duration alone{0};      ///< How long only one sensor has seen it since then.
  Duration through{0};    ///< How long sensors have seen through its expected place.
  Build build = {};       ///< Measured since it was found, or found again.
  /// Set if it was lost and found: the build of the lost person, and when it was lost.  Whether the
  /// two are the same person is not known yet.
  std::optional<Build> before = {};
  Timestamp lost = {};
  /// The id is final as far as is known: the person is no missing one, or a recognised one.
  bool named = false;
};

/// A person who left, or who was not found for too long.
struct Missing {
  PersonId id;
  Timestamp seen;  ///< When last seen.
  Build build;
};

struct Tracks {
  std::uint64_t next_id = 1;
  Timestamp instant;  ///< The last instant that was grouped.
  std::vector<Track> people;
  std::vector<Missing> missing = {};  ///< In the order of leaving.
};

/// A track while its instant is being processed.
struct Candidate {
  Track track;
  Eigen::Vector3d predicted = Eigen::Vector3d::Zero();  ///< Where its core should be [m].
  double gate = 0.0;  ///< How far from there it is looked for [m].
  std::vector<PlacedView> sights = {};
};

}  // namespace chorus::associate
