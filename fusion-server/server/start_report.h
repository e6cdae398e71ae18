// What a fusion server makes sure of and logs when it starts.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "common/service/recordings.h"
#include "common/service/serving.h"
#include "common/time/clock.h"
#include "fusion-server/server/fusion_settings.h"

namespace chorus::server {

/// Logs for each unusable folder what is wrong with it; the server runs without that folder.
/// Returns what is wrong with the state folder; empty if nothing is.
[[nodiscard]] std::string probe_folders(const StartSettings& config,
                                        const std::string& state_folder);

[[nodiscard]] service::RecordingsOptions recordings_options(const StartSettings& config,
                                                            const service::Serving& serving,
                                                            std::shared_ptr<const Clock> clock);

void report_start(const FusionSettings& settings, std::uint16_t port);

}  // namespace chorus::server
