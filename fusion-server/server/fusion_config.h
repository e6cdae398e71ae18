// Everything deploy/config/fusion.json can say, as plain values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/http/server.h"
#include "common/service/log_config.h"
#include "common/service/recordings.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/outputs/outputs.h"
#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/poll/poller.h"
#include "fusion-server/registration/registration.h"

namespace chorus::server {

struct FusionConfig {
  std::string title = "Chorus fusion server";
  http::ServerConfig http;
  service::LogConfig log;
  std::vector<poll::PolledSensor> sensors;
  poll::PollTimings poll;
  core::TickConfig output;
  Duration history = std::chrono::seconds(10);  ///< How long /frames/{seq} and ?at= reach back.
  pipeline::PipelineConfig pipeline;
  registration::RegistrationConfig registration;
  core::SessionConfig session;
  outputs::OutputsConfig outputs;
  std::string registration_file;  ///< Given extrinsics; empty: registered from a walk.
  std::string state_dir;          ///< Where the registration survives a restart; empty: nowhere.
  service::RecordingConfig recording;
  std::string viewer_dir;  ///< Static files of /viewer/; empty: no viewer.
};

/// Every mistake is named, all at once.
[[nodiscard]] Result<FusionConfig> read_fusion_config(ConfigReader root);

/// `overrides` are "path=value" of the command line.
[[nodiscard]] Result<FusionConfig> read_fusion_config(std::string_view text,
                                                      std::string_view origin,
                                                      const std::vector<std::string>& overrides);

/// Reads the file first.
[[nodiscard]] Result<FusionConfig> load_fusion_config(const std::string& path,
                                                      const std::vector<std::string>& overrides);

/// Keys whose change needs a restart ("http.port, state_dir"); empty when all can be taken over
/// live.
[[nodiscard]] std::string needs_restart(const FusionConfig& now, const FusionConfig& next);

}  // namespace chorus::server
