// What a fusion server makes of its settings before it runs, and how its routes reach the pipeline.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fusion-server/core/core_config.h"
#include "fusion-server/rest/registration_resources.h"
#include "fusion-server/server/fusion_settings.h"
#include "fusion-server/server/pipeline_loop.h"
#include "fusion-server/server/registration_store.h"

namespace chorus::server {

[[nodiscard]] core::CoreConfig core_config(const FusionSettings& settings);

[[nodiscard]] std::vector<SensorId> ids_of(const std::vector<client::FollowedService>& sensors);

/// The lowest id that a person may get; 1, with an error in the log, if what is stored is damaged.
[[nodiscard]] std::uint64_t first_person(const RegistrationStore& store);

/// What the routes of the registration ask of the pipeline; `ask` must only post the command.  Its
/// defaults are set elsewhere.
[[nodiscard]] rest::RegistrationControl registration_control(std::function<void(Command)> ask);

}  // namespace chorus::server
