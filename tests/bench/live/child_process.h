// One of our programs, started by a benchmark and ended with it.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::bench {

/// The environment that a program gets when it starts, besides its arguments.
struct ChildSurroundings {
  int error_output = -1;          ///< Descriptor that its stderr is sent to; -1: /dev/null.
  std::size_t descriptors = 0;    ///< Soft limit of open file descriptors; 0: ours.
  std::size_t address_space = 0;  ///< Limit of virtual memory [bytes]; 0: ours.
  /// Each "NAME=value", in addition to our environment.
  std::vector<std::string> environment = {};
  /// A folder that becomes a file system of one megabyte, visible to this program only.  Needs
  /// root.
  std::string small_disk = {};
};

class ChildProcess {
 public:
  /// Starts a program from this program's folder, or from a path; its output goes to /dev/null.
  [[nodiscard]] static Result<ChildProcess> start(const std::string& program,
                                                  const std::vector<std::string>& arguments,
                                                  const ChildSurroundings& surroundings = {});
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();  ///< Sends SIGTERM, even to a stopped process, and SIGKILL 5 s later.

  /// User and system time used so far [s].
  [[nodiscard]] double cpu_seconds() const;
  /// Current resident memory [MB]; 0 when it has ended.
  [[nodiscard]] double resident_mb() const;
  /// Number of open file descriptors.
  [[nodiscard]] std::size_t descriptors() const;
  [[nodiscard]] bool alive() const;
  void send(int signal) const;
  /// Ends it by SIGKILL and waits for it.
  void kill();
  /// Waits until it ends by itself; returns its exit code, 128 + signal, or -1: still running.
  [[nodiscard]] int wait(double patience_s);

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_ = -1;
};

}  // namespace chorus::bench
