#include "services/ctl/line/offline_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/service/config_source.h"
#include "fusion-server/fusion/methods.h"
#include "fusion-server/server/fusion_settings.h"

namespace chorus::ctl {

namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const fusion::MethodRow& row : fusion::methods()) names.emplace_back(row.name);
  return names;
}

/// "cam1,cam2=4.31" as a configuration key.
Result<std::string> known_distance(const std::string& text) {
  const std::size_t comma = text.find(',');
  const std::size_t equals = text.find('=');
  if (comma == std::string::npos || equals == std::string::npos || comma > equals)
    return fail(ErrorCode::InvalidArgument, "--distance", "write it as cam1,cam2=4.31");
  const nlohmann::json between{text.substr(0, comma), text.substr(comma + 1, equals - comma - 1)};
  return fmt::format("registration.known_distances=[{{\"between\":{},\"m\":{}}}]", between.dump(),
                     text.substr(equals + 1));
}

}  // namespace

void add_offline_options(CLI::App& app, OfflineOptions& options) {
  app.add_option("--config", options.config, "The fusion server's configuration (its defaults)");
  app.add_option("--set", options.overrides, "Override one key of it: path=value; may be repeated")
      ->take_all()
      ->allow_extra_args(false);
  app.add_option("--method", options.method, "How the views become one body")
      ->check(CLI::IsMember(method_names()));
  app.add_option("--joints", options.joints, "What registration goes by")
      ->check(CLI::IsMember({"neck", "core", "all"}));
  app.add_option("--stature", options.stature,
                 "Height of the person [m]: scale for cameras that guess depth from it")
      ->check(CLI::Range(0.5, 2.5));
  app.add_option("--distance", options.distance,
                 "One measured distance [m], as in cam1,cam2=4.31: the same, more exactly");
}

Result<pipeline::OfflineConfig> offline_config(const OfflineOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.method.empty()) overrides.push_back("fusion.method=" + options.method);
  if (!options.joints.empty()) overrides.push_back("registration.joints=" + options.joints);
  if (!options.stature.empty()) overrides.push_back("registration.stature_m=" + options.stature);
  if (!options.distance.empty()) {
    const auto known = known_distance(options.distance);
    if (!known) return pass(known);
    overrides.push_back(*known);
  }
  const auto read =
      service::read_config({options.config, overrides}).and_then(server::read_fusion_settings);
  if (!read) return pass(read);
  pipeline::OfflineConfig config;
  config.pipeline = read->live.pipeline;
  config.registration = read->live.registration;
  config.worn = read->live.worn;
  config.rate_hz = read->live.output.rate_hz;
  return config;
}

}  // namespace chorus::ctl
