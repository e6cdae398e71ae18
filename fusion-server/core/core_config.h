// The settings of everything that the pipeline thread decides.
#pragma once

#include <cstdint>
#include <set>

#include "common/base/strong_id.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/registration/registration.h"
#include "fusion-server/watch/watch_config.h"
#include "fusion-server/worn/worn_config.h"

namespace chorus::core {

struct CoreConfig {
  TickConfig output;
  pipeline::PipelineConfig pipeline;
  registration::RegistrationConfig registration;
  SessionConfig session;
  watch::WatchConfig watch;
  worn::WornConfig worn;
  std::set<SensorId> sensors;   ///< Frames of other sensors are ignored.
  std::set<SensorId> inertial;  ///< Inertial sources, which are none of the sensors.
  std::uint64_t first_sequence = 1;
  std::uint64_t first_session = 1;
  std::uint64_t first_person = 1;
};

}  // namespace chorus::core
