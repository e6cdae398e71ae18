// The settings in deploy/config/evaluation.json, as a struct with two parts.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/client/followers.h"
#include "common/http/server.h"
#include "common/inertial/limb.h"
#include "common/service/log_config.h"

namespace chorus::evaluation_service {

/// The part that a reload applies.
struct LiveSettings {
  service::LogConfig log;
  std::vector<http::Token> tokens;                ///< From the section http.
  std::optional<tls::Identity> identity;          ///< From the section http.
  std::vector<client::FollowedService> trackers;  ///< The one that is judged.
  std::vector<client::FollowedService> inertial;  ///< Whose /orientations judge it.

  bool operator==(const LiveSettings&) const = default;
};

/// By source: the limbs of sensors whose names do not say them.
using NamedLimbs = std::map<SensorId, std::map<std::string, inertial::Limb>>;

/// The part that needs a restart.
struct StartSettings {
  std::string title = "Chorus evaluation";
  http::ServerConfig http = {.port = 8092};  ///< Without tokens and identity.
  bool secure = false;                       ///< True if there is an identity.
  client::PollTimings poll = {};
  double tau = 0.0;         ///< An error begins above this [rad].
  bool own_tau = false;     ///< Where a limb's own threshold is smaller, that.
  bool stated = false;      ///< Judges the orientations that the tracker states.
  NamedLimbs limbs = {};    ///< "limbs" of the sources.
  std::string calibration;  ///< A file; empty: calibrates itself.

  bool operator==(const StartSettings&) const = default;
};

struct EvaluationSettings {
  LiveSettings live;
  StartSettings at_start;

  bool operator==(const EvaluationSettings&) const = default;
};

/// Reads all settings; one Error reports all mistakes.
[[nodiscard]] Result<EvaluationSettings> read_evaluation_settings(ConfigReader root);

}  // namespace chorus::evaluation_service
