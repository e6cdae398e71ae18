// chorus-fusion: many sensors, one tracker.
#include <csignal>
#include <cstdio>
#include <memory>

#include "common/base/log.h"
#include "fusion-server/server/command_line.h"
#include "fusion-server/server/fusion_server.h"

namespace {

using namespace chorus;
using server::CommandLine;

int refuse(const Error& error) {
  std::fprintf(stderr, "chorus-fusion: %s\n", to_string(error).c_str());
  return server::kExitMistaken;
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

void reload(server::FusionServer& fusion, const CommandLine& command) {
  const auto next = server::load_fusion_config(command.config, command.overrides);
  if (next) return fusion.reload(*next);
  log::error("configuration not reloaded, the old one stays",
             {{"reason", to_string(next.error())}});
}

Result<void> set_up_log(const CommandLine& command) {
  const auto level = log::parse_level(command.log_level);
  if (!level) return pass(level);
  const auto format = log::parse_format(command.log_format);
  if (!format) return pass(format);
  log::configure(*level, *format);
  return {};
}

int serve(const CommandLine& command, const server::FusionConfig& config) {
  const sigset_t signals = block_signals();
  server::FusionServer fusion(config, std::make_shared<SystemClock>());
  if (const auto started = fusion.start(); !started) return refuse(started.error());
  log::info("fusion server ready", {{"address", config.http.address},
                                    {"port", fusion.port()},
                                    {"sensors", config.sensors.size()}});
  int signal = 0;
  while (sigwait(&signals, &signal) == 0 && signal == SIGHUP) reload(fusion, command);
  log::info("stopping", {{"signal", signal}});
  fusion.stop();
  return server::kExitStopped;
}

int run(const CommandLine& command) {
  if (const auto ok = set_up_log(command); !ok) return refuse(ok.error());
  const auto config = server::load_fusion_config(command.config, command.overrides);
  if (!config) return refuse(config.error());
  if (!command.check_only) return serve(command, *config);
  std::printf("%s is good: %zu sensors\n", command.config.c_str(), config->sensors.size());
  return server::kExitStopped;
}

}  // namespace

int main(int argc, char** argv) {
  const CommandLine command = server::read_command_line(argc, argv);
  return command.exit ? *command.exit : run(command);
}
