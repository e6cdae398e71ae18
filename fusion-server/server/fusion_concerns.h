// What would not work, or not as it is meant, if a fusion server started with these settings now.
#pragma once

#include "common/service/concerns.h"
#include "fusion-server/server/fusion_settings.h"

namespace chorus::server {

/// What the settings show by themselves: two outputs on one port, sensors that are named but not
/// configured, a sensor that is this server.  Also logged at the start.
[[nodiscard]] service::Concerns setting_concerns(const FusionSettings& settings);

/// What this host shows as well: folders, ports that are taken, files that cannot be read.  Changes
/// nothing.
[[nodiscard]] service::Concerns host_concerns(const FusionSettings& settings);

}  // namespace chorus::server
