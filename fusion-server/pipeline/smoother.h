// Fuses instants some time after they happened, with what later instants say about them: which side
// of a person is which (facing/later_sides.h), and where their joints were (fusion/smoothing.h).
//
// A plain value without clock, thread or socket.  It remembers the frames of
// PipelineConfig::smoothing, however long it runs.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <vector>

#include "fusion-server/pipeline/pipeline.h"

namespace chorus::pipeline {

/// What perceive() found at an instant, as far as fusing it needs.
struct Perception {
  Inputs in;
  std::vector<SensorId> sensors;  ///< Snapshot::sensors.
  std::vector<Person> people;
  std::vector<SensorReport> reports;
  std::set<PersonId> tracked;                   ///< Everybody, seen or not.
  std::map<PersonId, facing::SidesStep> sides;  ///< Of those whose sides were resolved.
  std::uint64_t registration_version = 0;
  std::vector<Correction> corrections = {};
  std::vector<SeenHand> hands = {};
};

[[nodiscard]] Perception perception_of(const Inputs& in, std::vector<SensorId> sensors,
                                       const Perceived& seen);

class Smoother {
 public:
  /// Takes the next instant; returns those that are finished, in order of time.  Their memory is
  /// empty.
  [[nodiscard]] std::vector<Step> take(Perception now, const PipelineConfig& config);
  /// Takes what was found at an instant that was taken before, with frames that came too late for
  /// it; nothing if it is fused already.
  void amend(Perception better);
  /// All that are left, smoothed as far as there are later instants.
  [[nodiscard]] std::vector<Step> finish(const PipelineConfig& config);

 private:
  void settle_sides(Person& person, double change_odds);
  void fuse_oldest(const PipelineConfig& config);
  [[nodiscard]] Step smooth_oldest();

  std::deque<Perception> waiting_;       ///< For evidence about sides.
  std::deque<Step> fused_;               ///< Waiting for later bodies.
  Memory memory_;                        ///< Of fusion and seating.
  std::map<PersonId, bool> exchanged_;   ///< Whether the sides held at the last instant were wrong.
  Timestamp newest_ = Timestamp::min();  ///< Of all instants taken.
};

}  // namespace chorus::pipeline
