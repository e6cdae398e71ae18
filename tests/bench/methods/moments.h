// The input of fusion: every person at every instant with all views, made once for all methods.
#pragma once

#include <functional>
#include <vector>

#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

struct Moment {
  Timestamp instant;
  std::vector<Person> people;
  std::vector<SensorReport> reports;
};

struct Period {
  Timestamp begin;
  Timestamp end;
  double rate_hz = 30.0;
};

/// Feeds recorded tracks as if live: the histories contain what an instant needs, and nothing
/// later.
class Arriving {
 public:
  explicit Arriving(const std::vector<registration::WalkTrack>& tracks)
      : tracks_(tracks), next_(tracks.size(), 0) {}

  /// Advances until every sensor has passed the instant.
  [[nodiscard]] const pipeline::Histories& until(Timestamp instant);

 private:
  const std::vector<registration::WalkTrack>& tracks_;
  std::vector<std::size_t> next_;
  pipeline::Histories histories_;
};

/// Runs the pipeline, without fusion, at each instant of the time span, in order.
void visit_moments(const std::vector<registration::WalkTrack>& tracks,
                   const Registration& registration, const Period& period,
                   const std::function<void(Moment)>& visit,
                   const pipeline::PipelineConfig& config = {});

/// Visits the input of association at each instant of the time span.
void visit_scenes(const std::vector<registration::WalkTrack>& tracks,
                  const Registration& registration, const Period& period,
                  const std::function<void(const associate::Scene&)>& visit);

/// All moments of the time span.
[[nodiscard]] std::vector<Moment> moments_of(const std::vector<registration::WalkTrack>& tracks,
                                             const Registration& registration, const Period& period,
                                             const pipeline::PipelineConfig& config = {});

/// What the product makes of every moment of the time span when each waits for later ones.
[[nodiscard]] std::vector<Snapshot> smoothed_moments(
    const std::vector<registration::WalkTrack>& tracks, const Registration& registration,
    const Period& period, const pipeline::PipelineConfig& config = {});

}  // namespace chorus::bench
