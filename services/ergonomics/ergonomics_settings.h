// The settings in deploy/config/ergonomics.json, as a struct with two parts.
#pragma once

#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/client/followers.h"
#include "common/ergonomics/asked.h"
#include "common/http/server.h"
#include "common/service/log_config.h"

namespace chorus::ergonomics_service {

/// The part that a reload applies.
struct LiveSettings {
  service::LogConfig log;
  std::vector<http::Token> tokens;
  std::optional<tls::Identity> identity;

  bool operator==(const LiveSettings&) const = default;
};

/// The part that needs a restart.
struct StartSettings {
  http::ServerConfig http = {.port = 8093};  ///< Without tokens and identity.
  bool secure = false;
  client::FollowedService tracker;  ///< Whose /frame is scored.
  client::PollTimings poll = {};
  std::string methods = "reba,rula,owas,iso11226,en1005-4,eaws-like";
  std::string scene;  ///< File of the workplace (reach and view); empty: none.
  std::string rules;  ///< File of named postures beside the shipped ones; empty: none.

  bool operator==(const StartSettings&) const = default;
};

struct ErgonomicsSettings {
  LiveSettings live;
  StartSettings at_start;

  bool operator==(const ErgonomicsSettings&) const = default;
};

/// Reads all settings; one Error reports all mistakes.
[[nodiscard]] Result<ErgonomicsSettings> read_ergonomics_settings(ConfigReader root);

}  // namespace chorus::ergonomics_service
