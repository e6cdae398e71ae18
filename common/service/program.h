// The shell around every service: from its command line to its exit code.
//
// Signals are taken one by one by the main thread (sigwait), so that no handler interrupts other
// code: SIGTERM and SIGINT stop, SIGHUP reads the configuration again.  A wrong configuration then
// changes nothing.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/service/command_line.h"
#include "common/service/log_config.h"

namespace chorus::service {

/// One service as its shell sees it.  Every call comes from the main thread.
class Program {
 public:
  virtual ~Program() = default;

  /// Reads the whole configuration, ConfigReader::finish() included, and makes what can be made
  /// without binding a port.  Called once, first.
  [[nodiscard]] virtual Result<LogConfig> prepare(ConfigReader config) = 0;
  /// After prepare: what would not work if it started now, each with what to do.  Binds nothing
  /// and changes nothing.
  [[nodiscard]] virtual std::vector<std::string> concerns() { return {}; }
  /// Binds and runs; returns at once.
  [[nodiscard]] virtual Result<void> start() = 0;
  /// Takes over what can change while running and warns of what cannot.  On an Error everything is
  /// as before.
  [[nodiscard]] virtual Result<LogConfig> reload(ConfigReader config) = 0;
  virtual void stop() = 0;
  /// While running: false when a thread that everything depends on has not moved for a while.  The
  /// watchdog of systemd then starts the program again.
  [[nodiscard]] virtual bool alive() { return true; }
};

[[nodiscard]] int run_program(const About& about, Program& program, int argc,
                              const char* const* argv);

}  // namespace chorus::service
