// The frame around every service: from its command line to its exit code.
//
// The main thread takes signals one by one (sigwait), so that no handler interrupts other code:
// SIGTERM and SIGINT stop, SIGHUP reads the configuration again.  If that configuration is wrong,
// nothing changes.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/service/command_line.h"
#include "common/service/log_config.h"

namespace chorus::service {

/// One service as this frame sees it.  Every call comes from the main thread.
class Program {
 public:
  virtual ~Program() = default;

  /// Reads the whole configuration, calls ConfigReader::finish(), and creates everything that needs
  /// no port.  Called once, first.
  [[nodiscard]] virtual Result<LogConfig> prepare(ConfigReader config) = 0;
  /// Called after prepare: what would not work if it started now, each with advice.  Binds nothing
  /// and changes nothing.
  [[nodiscard]] virtual std::vector<std::string> concerns() { return {}; }
  /// Binds the ports and starts to run; returns at once.
  [[nodiscard]] virtual Result<void> start() = 0;
  /// Applies what can change while running and warns of what cannot.  On an Error everything stays
  /// as before.
  [[nodiscard]] virtual Result<LogConfig> reload(ConfigReader config) = 0;
  virtual void stop() = 0;
  /// While running: false when a thread that everything depends on has hung for a while.  The
  /// watchdog of systemd then restarts the program.
  [[nodiscard]] virtual bool alive() { return true; }
};

[[nodiscard]] int run_program(const About& about, Program& program, int argc,
                              const char* const* argv);

}  // namespace chorus::service
