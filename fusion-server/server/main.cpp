// chorus-fusion: many sensors, one tracker.
#include <csignal>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/log.h"
#include "fusion-server/server/fusion_server.h"

namespace {

using namespace chorus;

constexpr int kBadStart = 2;  ///< Wrong configuration or address in use; nothing else ends us.

struct Arguments {
  std::string config;
  std::vector<std::string> overrides;
  std::string log_format = "text";
  std::string log_level = "info";
  bool check = false;
};

int refuse(const Error& error) {
  std::fprintf(stderr, "chorus-fusion: %s\n", to_string(error).c_str());
  return kBadStart;
}

/// Signals are taken one by one by the main thread, so that no handler interrupts anybody.
sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

void reload(server::FusionServer& fusion, const Arguments& arguments) {
  const auto next = server::load_fusion_config(arguments.config, arguments.overrides);
  if (next) return fusion.reload(*next);
  log::error("configuration not reloaded, the old one stays",
             {{"reason", to_string(next.error())}});
}

int run(const Arguments& arguments) {
  const auto level = log::parse_level(arguments.log_level);
  const auto format = log::parse_format(arguments.log_format);
  if (!level) return refuse(level.error());
  if (!format) return refuse(format.error());
  log::configure(*level, *format);
  const auto config = server::load_fusion_config(arguments.config, arguments.overrides);
  if (!config) return refuse(config.error());
  if (arguments.check) {
    std::printf("%s is good: %zu sensors\n", arguments.config.c_str(), config->sensors.size());
    return 0;
  }

  const sigset_t signals = block_signals();
  server::FusionServer fusion(*config, std::make_shared<SystemClock>());
  if (const auto started = fusion.start(); !started) return refuse(started.error());
  log::info("fusion server ready", {{"address", config->http.address},
                                    {"port", fusion.port()},
                                    {"sensors", config->sensors.size()}});
  int signal = 0;
  while (sigwait(&signals, &signal) == 0 && signal == SIGHUP) reload(fusion, arguments);
  log::info("stopping", {{"signal", signal}});
  fusion.stop();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Polls body-tracking sensors, registers and fuses them, and answers as one tracker.",
               "chorus-fusion");
  Arguments arguments;
  app.add_option("--config", arguments.config, "Configuration file (deploy/config/fusion.json)")
      ->required();
  app.add_option("--set", arguments.overrides, "PATH=VALUE, such as http.port=8090; repeatable")
      ->take_all();
  app.add_option("--log-format", arguments.log_format, "text or json");
  app.add_option("--log-level", arguments.log_level, "debug, info, warn or error");
  app.add_flag("--check", arguments.check, "Say whether the configuration is good, and end");
  app.footer("SIGHUP reloads the configuration, SIGTERM stops.");
  CLI11_PARSE(app, argc, argv);
  return run(arguments);
}
