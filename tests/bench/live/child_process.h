// A program of ours, started by a benchmark and ended with it.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::bench {

/// What a program finds when it starts, beside its arguments.
struct ChildSurroundings {
  int error_output = -1;          ///< Its stderr goes to this descriptor; -1: to /dev/null.
  std::size_t descriptors = 0;    ///< The soft limit it is given; 0: ours.
  std::size_t address_space = 0;  ///< Limit [bytes]; 0: ours.
  /// "NAME=value", beside what we have.
  std::vector<std::string> environment = {};
  /// A folder that is a file system of one megabyte for this program alone.  Needs root.
  std::string small_disk = {};
};

class ChildProcess {
 public:
  /// Starts a program that stands beside this one, or at a path; its output goes to /dev/null.
  [[nodiscard]] static Result<ChildProcess> start(const std::string& program,
                                                  const std::vector<std::string>& arguments,
                                                  const ChildSurroundings& surroundings = {});
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();  ///< SIGTERM (also when it is stopped), waits 5 s, then SIGKILL.

  /// User and system time so far [s].
  [[nodiscard]] double cpu_seconds() const;
  /// Resident memory now [MB]; 0 when it has ended.
  [[nodiscard]] double resident_mb() const;
  /// Open file descriptors now.
  [[nodiscard]] std::size_t descriptors() const;
  [[nodiscard]] bool alive() const;
  void send(int signal) const;
  /// Ends it by SIGKILL and waits for it.
  void kill();
  /// Waits for it to end by itself; its exit code, 128 + signal, or -1: still running.
  [[nodiscard]] int wait(double patience_s);

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_ = -1;
};

}  // namespace chorus::bench
