#include "services/ctl/offline_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

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
}

Result<pipeline::OfflineConfig> offline_config(const OfflineOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.method.empty()) overrides.push_back("fusion.method=" + options.method);
  if (!options.joints.empty()) overrides.push_back("registration.joints=" + options.joints);
  const auto read =
      service::read_config({options.config, overrides}).and_then(server::read_fusion_settings);
  if (!read) return pass(read);
  pipeline::OfflineConfig config;
  config.pipeline = read->live.pipeline;
  config.registration = read->live.registration;
  config.rate_hz = read->live.output.rate_hz;
  return config;
}

}  // namespace chorus::ctl
