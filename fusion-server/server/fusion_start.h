// What a fusion server makes of its settings before it runs, and how its routes reach the pipeline.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/service/recording_views.h"
#include "fusion-server/core/core_config.h"
#include "fusion-server/rest/registration_resources.h"
#include "fusion-server/server/fusion_settings.h"
#include "fusion-server/server/pipeline_loop.h"
#include "fusion-server/server/registration_store.h"

namespace chorus::server {

[[nodiscard]] core::CoreConfig core_config(const FusionSettings& settings);

[[nodiscard]] std::vector<SensorId> ids_of(const std::vector<client::FollowedService>& sensors);

/// Ids, sequences and sessions that are new after a restart.
void count_on(core::CoreConfig& config, Timestamp now, const RegistrationStore& store);

/// Looking at the recordings, the one that runs included.
[[nodiscard]] service::RecordingViewsOptions views_options(service::Recordings& recordings,
                                                           const service::RecordingConfig& config,
                                                           const std::string& run);

/// What the routes of the registration ask of the pipeline; `ask` must only post the command.  Its
/// defaults are set elsewhere.
[[nodiscard]] rest::RegistrationControl registration_control(std::function<void(Command)> ask);

}  // namespace chorus::server
