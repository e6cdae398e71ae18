// The frame around every service, from its command line to its exit code.
//
// The main thread waits for signals (sigwait), so that no handler interrupts other code: SIGTERM
// and SIGINT stop the service, SIGHUP makes it read the configuration again.  If that configuration
// is wrong, nothing changes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/service/command_line.h"
#include "common/service/configuration.h"
#include "common/service/log_config.h"

namespace chorus::service {

/// One service, as this frame uses it.  All calls come from the main thread.
class Program {
 public:
  virtual ~Program() = default;

  /// Reads the whole configuration, calls ConfigReader::finish(), and creates everything that needs
  /// no port.  Called once, before the other functions.
  [[nodiscard]] virtual Result<LogConfig> prepare(ConfigReader config) = 0;
  /// What would not work if the service started now, each with advice.  Called after prepare().
  /// Binds nothing and changes nothing.
  [[nodiscard]] virtual std::vector<std::string> concerns() { return {}; }
  /// Binds the ports and starts to run; returns at once.
  [[nodiscard]] virtual Result<void> start() = 0;
  /// Applies what can change while the service runs, and logs a warning about what cannot.  On an
  /// Error nothing changes.
  [[nodiscard]] virtual Result<LogConfig> reload(ConfigReader config) = 0;
  virtual void stop() = 0;
  /// Called while running: false when a thread on which everything depends has hung for a while.
  /// Then the watchdog of systemd restarts the program.
  [[nodiscard]] virtual bool alive() { return true; }

  /// What the service says of its own configuration; the shell notes starts and failed reloads, the
  /// program what a reload changed.
  [[nodiscard]] const std::shared_ptr<Configuration>& configuration() const {
    return configuration_;
  }

 private:
  std::shared_ptr<Configuration> configuration_ = std::make_shared<Configuration>();
};

[[nodiscard]] int run_program(const About& about, Program& program, int argc,
                              const char* const* argv);

}  // namespace chorus::service
