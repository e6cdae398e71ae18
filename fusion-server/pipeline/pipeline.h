// Otto et al., Figure 10, as one pure step: takes histories, returns a snapshot.  No clock, no
// socket, no lock.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fusion-server/align/aligner.h"
#include "fusion-server/associate/person_association.h"
#include "fusion-server/facing/sides.h"
#include "fusion-server/flow/person.h"
#include "fusion-server/flow/registration.h"
#include "fusion-server/flow/snapshot.h"
#include "fusion-server/flow/worn_people.h"
#include "fusion-server/fusion/fuse.h"
#include "fusion-server/fusion/quality.h"
#include "fusion-server/pipeline/hands.h"
#include "fusion-server/pipeline/seating.h"

namespace chorus::pipeline {

/// How long an instant waits for later ones (smoother.h).
struct SmoothingConfig {
  bool live = false;  ///< The server smooths, too, for /frame?at=.
  /// For evidence about which side of a person is which.
  Duration sides = std::chrono::seconds(2);
  /// After that, for bodies.
  Duration bodies = std::chrono::milliseconds(300);

  bool operator==(const SmoothingConfig&) const = default;
};

struct PipelineConfig {
  align::AlignConfig align;
  fusion::QualityLimits quality;
  associate::AssociationConfig association;
  facing::SidesConfig sides;
  fusion::FusionConfig fusion;
  SeatingConfig seating;
  SmoothingConfig smoothing;
  /// The sensors that are polled.  Of the sensors with a place, only these are in
  /// Snapshot::sensors.  Not set: all with a place are.
  std::optional<std::set<SensorId>> polled = {};

  bool operator==(const PipelineConfig&) const = default;
};

/// Whether the method uses the weights of views, SensorReport::weight.
[[nodiscard]] bool uses_weights(fusion::Method method);

using Histories = std::map<SensorId, align::History>;

struct Inputs {
  Timestamp instant;  ///< The common instant to fuse.
  Timestamp now;      ///< When the server computes this.
  std::uint64_t sequence = 0;
  WornPeople worn = {};  ///< What inertial sensors on people say at the instant.
};

/// The state that one instant passes to the next.
struct Memory {
  associate::Tracks tracks;
  facing::SidesMemory sides;
  fusion::Memory fusion;
  Seating seating;
};

/// Forgets what fusion and sides have learned of a person.
void forget(PersonId person, Memory& memory);
/// Forgets it of the people who were published under each other's ids: since then, one has taught
/// what is kept under the other's.
void forget(const std::vector<Correction>& corrections, Memory& memory);

/// The result of all stages before fusion: the people at an instant, each with all views.
struct Perceived {
  std::vector<Person> people;
  std::vector<SensorReport> reports;
  Memory memory;
  std::uint64_t registration_version = 0;
  std::vector<Correction> corrections = {};
  std::vector<Standing> standings = {};  ///< As Grouping::standings.
  std::vector<SeenHand> hands = {};
};

struct Step {
  Snapshot snapshot;
  Memory memory;
  std::vector<Person> people;  ///< What was fused: for each person all views, in world space.
  std::vector<Standing> standings = {};  ///< As Grouping::standings.
};

/// A sensor whose frame for an instant may still arrive, and how long it is waited for.
struct Awaited {
  SensorId sensor;
  align::AlignConfig align;
};

struct Waiting {
  std::vector<Awaited> sensors;
  Duration extension{0};  ///< Additional wait, because most of the sensors are slow.
};

/// The sensors to wait for before any has answered for an instant: every sensor that has a place
/// and has delivered a frame.
[[nodiscard]] Waiting all_awaited(const Histories& histories, const Registration& registration,
                                  const PipelineConfig& config);

/// Removes the sensors that have answered or are too late.  When none is left, waiting longer
/// cannot improve the result.
void drop_settled(std::vector<Awaited>& awaited, const Inputs& in, const Histories& histories);

/// The input of association: all bodies of all sensors that have a place, in world space.
[[nodiscard]] associate::Scene scene_at(const Inputs& in, const Histories& histories,
                                        const Registration& registration,
                                        const PipelineConfig& config);

/// Runs all stages of step() before fusion; returns the views that are to be fused.
[[nodiscard]] Perceived perceive(const Inputs& in, const Histories& histories,
                                 const Registration& registration, const Memory& memory,
                                 const PipelineConfig& config);

/// Sets the weights of all views, Eqs. (1)-(3).
void weigh(std::vector<Person>& people, const fusion::QualityLimits& limits);

/// The sensors with a place that can deliver: Snapshot::sensors.
[[nodiscard]] std::vector<SensorId> taking_part(const Registration& registration,
                                                const PipelineConfig& config);

/// The rest of step(): makes a body of each person, and seats them.  Of the memory it needs only
/// that of fusion and seating.
[[nodiscard]] Step fuse(Perceived seen, const Inputs& in, std::vector<SensorId> sensors,
                        const PipelineConfig& config);

/// perceive(), then fuse().
[[nodiscard]] Step step(const Inputs& in, const Histories& histories,
                        const Registration& registration, const Memory& memory,
                        const PipelineConfig& config);

}  // namespace chorus::pipeline
