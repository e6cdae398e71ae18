// All settings of deploy/config/fusion.json as plain values, in two parts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/client/followers.h"
#include "common/http/server.h"
#include "common/service/log_config.h"
#include "common/service/recordings.h"
#include "common/workplace/prop.h"
#include "fusion-server/core/registration_session.h"
#include "fusion-server/core/tick_schedule.h"
#include "fusion-server/outputs/outputs.h"
#include "fusion-server/pipeline/pipeline.h"
#include "fusion-server/registration/registration.h"
#include "fusion-server/server/site_settings.h"
#include "fusion-server/watch/watch_config.h"
#include "fusion-server/worn/worn_config.h"

namespace chorus::server {

/// The settings that a reload applies.
struct LiveSettings {
  service::LogConfig log;
  std::vector<http::Token> tokens;        ///< From the section http.
  std::optional<tls::Identity> identity;  ///< From the section http.
  std::vector<client::FollowedService> sensors;
  tls::Trust trust;  ///< The authorities accepted for https, also of sensors that are added later.
  /// Services whose /orientations are followed.  They have no place, take part in no walk, and are
  /// none of the sensors.
  std::vector<client::FollowedService> inertial;
  core::TickConfig output;
  pipeline::PipelineConfig pipeline;
  registration::RegistrationConfig registration;
  core::SessionConfig session;
  watch::WatchConfig watch;
  worn::WornConfig worn;  ///< From the section fusion.inertial.
  outputs::OutputsConfig outputs;
  std::string site_places;  ///< Where the cells of the site stand; see read_site().

  bool operator==(const LiveSettings&) const = default;
};

/// The settings that require a restart.
struct StartSettings {
  std::string title = "Chorus fusion server";
  http::ServerConfig http = {.port = 8080};  ///< Without tokens and identity.
  bool secure = false;                       ///< True if there is an identity.
  client::PollTimings poll;
  Duration history = std::chrono::seconds(10);  ///< How far back /frames/{seq} and ?at= reach.
  /// A file with given extrinsics; empty: the sensors are registered from a walk.
  std::string registration_file;
  /// The folder for state that is kept across restarts; "auto": see state_folder(); empty: none.
  std::string state_dir;
  service::RecordingConfig recording;
  std::vector<workplace::Prop> props;  ///< Things that people take up and put down.
  /// The folder of the static files of /viewer/; "auto": see viewer_folder(); empty: no viewer.
  std::string viewer_dir;
  SiteSettings site;
  std::vector<client::FollowedService> evaluation;  ///< Who judges this tracker; at most one.

  bool operator==(const StartSettings&) const = default;
};

struct FusionSettings {
  LiveSettings live;
  StartSettings at_start;

  bool operator==(const FusionSettings&) const = default;
};

/// Reads all settings; one Error reports all mistakes.
[[nodiscard]] Result<FusionSettings> read_fusion_settings(ConfigReader root);

}  // namespace chorus::server
