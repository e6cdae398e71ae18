#include "common/service/program.h"

#include <csignal>
#include <cstdio>
#include <exception>

namespace chorus::service {
namespace {

sigset_t block_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGTERM, SIGINT, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  return signals;
}

int refuse(const About& about, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", about.name.c_str(), to_string(error).c_str());
  return kExitMistaken;
}

void reload(Program& program, const ConfigSource& source) {
  const auto taken = read_config(source).and_then(
      [&](const ConfigReader& config) { return program.reload(config); });
  if (!taken) {
    return log::error("configuration not reloaded, the old one stays",
                      {{"reason", to_string(taken.error())}});
  }
  apply(*taken);
  log::info("configuration reloaded");
}

int serve(const About& about, Program& program, const CommandLine& command) {
  const sigset_t signals = block_signals();  // before any thread starts
  const auto log = read_config(command.source).and_then([&](const ConfigReader& config) {
    return program.prepare(config);
  });
  if (!log) return refuse(about, log.error());
  if (command.check_only) {
    std::puts("The configuration is good.");
    return kExitStopped;
  }
  apply(*log);
  if (const auto started = program.start(); !started) return refuse(about, started.error());
  int signal = 0;
  while (sigwait(&signals, &signal) == 0 && signal == SIGHUP) reload(program, command.source);
  log::info("stopping", {{"signal", signal}});
  program.stop();
  return kExitStopped;
}

}  // namespace

int run_program(const About& about, Program& program, int argc, const char* const* argv) {
  const CommandLine command = read_command_line(about, argc, argv);
  if (command.exit) return *command.exit;
  try {
    return serve(about, program, command);
  } catch (const std::exception& failure) {
    log::error("broke down", {{"reason", failure.what()}});
    return kExitFailed;
  }
}

}  // namespace chorus::service
