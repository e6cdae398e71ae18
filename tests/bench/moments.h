// What fusion gets: every person at every instant with all their views, made once for all methods.
#pragma once

#include <vector>

#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/registration/registration.h"

namespace chorus::bench {

struct Moment {
  Timestamp instant;
  std::vector<Person> people;
};

struct Period {
  Timestamp begin;
  Timestamp end;
  double rate_hz = 30.0;
};

/// The pipeline up to fusion, at each instant of the period.
[[nodiscard]] std::vector<Moment> moments_of(const std::vector<registration::WalkTrack>& tracks,
                                             const Registration& registration, const Period& period,
                                             const pipeline::PipelineConfig& config = {});

}  // namespace chorus::bench
