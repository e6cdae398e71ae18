// Otto et al., Figure 10, as one pure step: histories in, snapshot out.  No clock, no socket, no
// lock.
#pragma once

#include <map>
#include <vector>

#include "fusion-server/align/aligner.h"
#include "fusion-server/associate/person_association.h"
#include "fusion-server/facing/sides.h"
#include "fusion-server/flow.h"
#include "fusion-server/fusion/fuse.h"
#include "fusion-server/fusion/quality.h"
#include "fusion-server/pipeline/seating.h"

namespace chorus::pipeline {

struct PipelineConfig {
  align::AlignConfig align;
  fusion::QualityLimits quality;
  associate::AssociationConfig association;
  facing::SidesConfig sides;
  fusion::FusionConfig fusion;
  SeatingConfig seating;

  bool operator==(const PipelineConfig&) const = default;
};

using Histories = std::map<SensorId, align::History>;

struct Inputs {
  Timestamp instant;  ///< The common instant to answer for.
  Timestamp now;      ///< The server's time at which this is computed.
  std::uint64_t sequence = 0;
};

/// What one instant leaves for the next.
struct Memory {
  associate::Tracks tracks;
  facing::SidesMemory sides;
  fusion::Memory fusion;
  Seating seating;
};

/// The result of everything before fusion: who is there at an instant, each with all views.
struct Perceived {
  std::vector<Person> people;
  std::vector<SensorReport> reports;
  Memory memory;
};

struct Step {
  Snapshot snapshot;
  Memory memory;
};

/// A sensor whose answer for an instant may still come, and how long it is waited for.
struct Awaited {
  SensorId sensor;
  align::AlignConfig align;
};

struct Waiting {
  std::vector<Awaited> sensors;
  Duration extension{0};  ///< How much longer than usual, because most of them are slow.
};

/// Before an instant: every sensor with a place.
[[nodiscard]] Waiting all_awaited(const Histories& histories, const Registration& registration,
                                  const PipelineConfig& config);

/// Takes out those whose answer is there, or too late.  When none is left, waiting longer cannot
/// improve the instant.
void drop_settled(std::vector<Awaited>& awaited, const Inputs& in, const Histories& histories);

/// Everything before association: all bodies of all sensors that have a place, in the world.
[[nodiscard]] associate::Scene scene_at(const Inputs& in, const Histories& histories,
                                        const Registration& registration,
                                        const PipelineConfig& config);

/// Everything in `step` before fusion: the views it hands to it.
[[nodiscard]] Perceived perceive(const Inputs& in, const Histories& histories,
                                 const Registration& registration, const Memory& memory,
                                 const PipelineConfig& config);

[[nodiscard]] Step step(const Inputs& in, const Histories& histories,
                        const Registration& registration, const Memory& memory,
                        const PipelineConfig& config);

}  // namespace chorus::pipeline
