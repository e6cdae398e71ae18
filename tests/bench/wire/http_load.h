// Servers under load, each in a process of its own: ours, nginx, and the load generators.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "tests/bench/live/scratch_folder.h"

namespace chorus::bench {

/// A forked process that serves until it is destroyed.
class ServingProcess {
 public:
  /// Forks; the child calls `serve`, which reports its port and returns after `wait_for_end` does.
  using Serve = std::function<void(const std::function<void(std::uint16_t)>& say_port,
                                   const std::function<void()>& wait_for_end)>;
  [[nodiscard]] static Result<ServingProcess> fork(const Serve& serve);
  /// Starts nginx with one worker on a free port, serving `body` at /frame as text/turtle.
  [[nodiscard]] static Result<ServingProcess> nginx(const std::string& body);

  ServingProcess(ServingProcess&& other) noexcept;
  ServingProcess& operator=(ServingProcess&&) = delete;
  ~ServingProcess();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// User and system time used by the process.
  [[nodiscard]] double cpu_seconds() const;

 private:
  ServingProcess() = default;
  pid_t pid_ = -1;
  int life_line_ = -1;  ///< The child ends when this closes.
  std::uint16_t port_ = 0;
  std::optional<ScratchFolder> folder_ = {};  ///< Configuration, document and logs of nginx.
};

enum class Side { Server, Load };
/// Pins this process, and the processes it starts, to one core: servers to one core, load
/// generators to another. Does nothing on a machine with one core.
void keep_to_side(Side side);

struct WrkResult {
  double requests_per_s = 0.0;
  double requests = 0.0;
};

/// Runs wrk with one thread and `connections` connections against http://127.0.0.1:port/frame.
[[nodiscard]] Result<WrkResult> run_wrk(std::uint16_t port, int connections, int run_seconds);

struct LongPollLoad {
  std::uint16_t port = 0;
  int clients = 300;
  double run_seconds = 5.0;
};

/// What long polls measured.  The server under test must begin every document with the time when
/// it was made, "# <steady ns>".
struct LongPollAges {
  /// Age of the document when received [s], one per answer after the warm-up.
  std::vector<double> ages;
  std::uint64_t answers = 0;             ///< All answers, including the warm-up.
  std::uint64_t repeated_or_missed = 0;  ///< Versions that did not follow the previous one.
};

/// Long-polls from a forked process with one epoll loop, as efficient as the server measured.
[[nodiscard]] Result<LongPollAges> run_long_polls(const LongPollLoad& load);

}  // namespace chorus::bench
