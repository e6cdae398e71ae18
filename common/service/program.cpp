#include "common/service/program.h"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>

#include "common/service/signals.h"
#include "common/service/supervisor.h"
#include "common/time/clock.h"

namespace chorus::service {
namespace {

/// A broken connection is told by its call; the others mean nothing to a service, and must not end
/// it only because somebody took one for a reload.
void ignore_signals() {
  for (const int signal : {SIGPIPE, SIGUSR1, SIGUSR2}) std::signal(signal, SIG_IGN);
}

int refuse(const About& about, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", about.name.c_str(), to_string(error).c_str());
  return kExitMistaken;
}

void reload(Program& program, const ConfigSource& source) {
  const auto taken = read_config(source).and_then(
      [&](const ConfigReader& config) { return program.reload(config); });
  if (!taken) {
    program.configuration()->reload_failed(taken.error(), SystemClock().now());
    return log::error("configuration not reloaded, the old one stays",
                      {{"reason", to_string(taken.error())}});
  }
  apply(*taken);
  log::info("configuration reloaded");
}

timespec timespec_of(std::chrono::microseconds time) {
  constexpr std::int64_t kPerSecond = 1'000'000;
  return {time.count() / kPerSecond, time.count() % kPerSecond * 1000};
}

/// Waits for the next signal; meanwhile reports to the supervisor, as often as it requires, that
/// the program is alive.
int next_signal(const sigset_t& signals, const Supervisor& supervisor, Program& program) {
  if (!supervisor.pulse()) {
    int signal = 0;
    sigwait(&signals, &signal);
    return signal;
  }
  const timespec pulse = timespec_of(*supervisor.pulse());
  while (true) {
    if (program.alive()) {
      supervisor.tell("WATCHDOG=1");
    } else {
      log::error("a thread stands still; the watchdog will start the service again");
    }
    if (const int signal = sigtimedwait(&signals, nullptr, &pulse); signal > 0) return signal;
  }
}

/// Runs the started service until a signal ends it.
void run(Program& program, const ConfigSource& source, const sigset_t& signals) {
  const Supervisor supervisor(own_environment());
  supervisor.tell("READY=1");
  int signal = 0;
  while ((signal = next_signal(signals, supervisor, program)) == SIGHUP) reload(program, source);
  supervisor.tell("STOPPING=1");
  log::info("stopping", {{"signal", signal}});
  program.stop();
}

int serve(const About& about, Program& program, const CommandLine& command) {
  const sigset_t signals = block_signals({SIGTERM, SIGINT, SIGHUP});  // Before any thread starts.
  ignore_signals();
  const auto log = read_config(command.source).and_then([&](const ConfigReader& config) {
    program.configuration()->started(command.source, config.text(), SystemClock().now());
    return program.prepare(config);
  });
  if (!log) return refuse(about, log.error());
  if (command.check_only) {
    const auto concerns = program.concerns();
    std::puts(concerns.empty() ? "The configuration is good."
                               : "The configuration is good.  What does not work on this host now "
                                 "is on standard error.");
    std::fflush(stdout);
    for (const std::string& concern : concerns)
      std::fprintf(stderr, "%s: but now, %s\n", about.name.c_str(), concern.c_str());
    return kExitStopped;
  }
  apply(*log);
  if (const auto started = program.start(); !started) return refuse(about, started.error());
  run(program, command.source, signals);
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
