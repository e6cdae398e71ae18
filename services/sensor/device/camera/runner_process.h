// A runner as a child process: images go into its standard input, lines come out of its standard
// output.  Its standard error goes to the log; the last line is kept, because it usually says why
// the process ended.
//
// Not thread-safe. Every wait that has a `stop` ends with Timeout when a stop is requested.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <memory>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/duration.h"
#include "common/base/rate_report.h"
#include "common/base/result.h"

namespace chorus::camera {

class RunnerProcess {
 public:
  /// Starts the process; NotFound when the program does not exist.
  [[nodiscard]] static Result<std::unique_ptr<RunnerProcess>> start(
      const std::vector<std::string>& command);
  /// Closes the process's input, which asks it to end, and kills it if it has not ended within a
  /// second.
  ~RunnerProcess();
  RunnerProcess(const RunnerProcess&) = delete;
  RunnerProcess& operator=(const RunnerProcess&) = delete;

  /// Writes to the process.  Unavailable when it has ended; the message contains its exit status
  /// and its last line on standard error.  Timeout when it does not read.
  [[nodiscard]] Result<void> send(std::string_view bytes, Duration within,
                                  const std::stop_token& stop);
  /// The next line of the process's output, without the line feed.  Errors as for send(), and
  /// TooLarge for a line of more than 256 kB.
  [[nodiscard]] Result<std::string> read_line(Duration within, const std::stop_token& stop);
  /// Reads the process's standard error.  Unavailable when the process has ended.
  [[nodiscard]] Result<void> listen();
  /// Closes the process's input and waits until it ends; an exit code other than 0 is an error.
  [[nodiscard]] Result<void> finish(Duration within);

 private:
  enum class Want { Read, Write };

  RunnerProcess() = default;
  /// Waits once, for at most a tenth of a second, and reads the process's standard error. Timeout
  /// when `until` is over or a stop is requested.
  [[nodiscard]] Result<void> wait_a_moment(Want want, SteadyTime until,
                                           const std::stop_token& stop);
  void take_words();
  /// Takes output that can be read; false at its end.
  [[nodiscard]] bool take_output();
  [[nodiscard]] bool reap();
  [[nodiscard]] Error obituary();

  std::string name_;  ///< Name in messages.
  pid_t pid_ = -1;
  int input_ = -1;   ///< Our end of the pipe to the process's standard input.
  int output_ = -1;  ///< Our end of the pipe from its standard output.
  int errors_ = -1;  ///< Our end of the pipe from its standard error.
  bool ended_ = false;
  int status_ = 0;
  std::string heard_;  ///< Output that has not been returned yet.
  std::string word_;   ///< The last line of the process's standard error, while it is incomplete.
  std::string last_words_;
  RateReport says_{"the runner says", log::Level::Info};
};

}  // namespace chorus::camera
