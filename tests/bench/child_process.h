// A program of ours, started by a benchmark and ended with it.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::bench {

class ChildProcess {
 public:
  /// Starts a program that stands beside this one; its output goes to /dev/null.
  [[nodiscard]] static Result<ChildProcess> start(const std::string& program,
                                                  const std::vector<std::string>& arguments);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();  ///< SIGTERM, and waits.

  /// User and system time so far [s].
  [[nodiscard]] double cpu_seconds() const;
  [[nodiscard]] bool alive() const;

 private:
  explicit ChildProcess(pid_t pid) : pid_(pid) {}
  pid_t pid_ = -1;
};

}  // namespace chorus::bench
