// A real chorus-fusion process polled by many clients.  Its sensors are served over HTTP from this
// process: they see standing people exactly, and all their capture times are known.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/result.h"
#include "common/time/timestamp.h"
#include "tests/bench/live/child_process.h"
#include "tests/bench/live/scratch_folder.h"

namespace chorus::bench {

/// Sensors on a ring, 30 Hz each, evenly out of phase.
class ExactSensors {
 public:
  ExactSensors(int count, int persons);
  ~ExactSensors();

  /// The value of the fusion server's setting "sensors".
  [[nodiscard]] std::string settings() const;
  [[nodiscard]] std::string places() const;
  /// When the last capture that the instant needs was published; the instant needs each sensor's
  /// first capture at or after it.  None: some sensor has not captured that frame yet, or no longer
  /// remembers it.
  [[nodiscard]] std::optional<Timestamp> last_needed_capture(Timestamp instant) const;

 private:
  void run(const std::stop_token& stop);
  struct Sensor;
  std::vector<std::unique_ptr<Sensor>> sensors_;
  int persons_;
  mutable std::mutex mutex_;  ///< Guards the captures.
  std::jthread thread_;
};

struct LiveCell {
  std::unique_ptr<ExactSensors> sensors;
  ScratchFolder folder;
  std::vector<ChildProcess> fusion;  ///< One process; ends before its folder is removed.
  std::uint16_t port = 0;
  std::uint16_t vrpn_port = 0;
};

/// Starts a cell and waits until `persons` bodies are fused.  `settings` of the server in addition,
/// each "key=value".
[[nodiscard]] Result<LiveCell> start_cell(int sensors, int persons,
                                          const std::vector<std::string>& settings = {});

/// Measurements of one VRPN client that reads the first person.
struct Lateness {
  std::vector<double> beyond_capture;  ///< Per frame: time since the last capture it needed [s].
  double output_hz = 0.0;
  std::size_t lost = 0;
};
[[nodiscard]] Result<Lateness> watch(const LiveCell& cell, double run_seconds);

/// How many clients of each kind there are; all of them only read.
struct ClientCounts {
  int vrpn = 0;
  int long_polls = 0;
  int event_streams = 0;
  int websockets = 0;
  std::uint16_t http_port = 0;  ///< Of what is between them and the server; 0: nothing is.
};
struct ClientAnswers {
  std::uint64_t vrpn_frames = 0;
  std::uint64_t long_polls = 0;
  std::uint64_t events = 0;
  std::uint64_t messages = 0;          ///< WebSocket messages.
  std::uint64_t lost = 0;              ///< Connections not made, and HTTP connections lost.
  std::vector<std::uint64_t> of_each;  ///< Frames by client, in the order in which they connected.
};

/// The frames that the client with the fewest received between the two.
[[nodiscard]] std::uint64_t fewest(const ClientAnswers& before, const ClientAnswers& after);

/// Runs all clients on one thread with one epoll set.
class ClientCrowd {
 public:
  ClientCrowd(const LiveCell& cell, const ClientCounts& counts);
  ~ClientCrowd();
  [[nodiscard]] ClientAnswers answers() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::bench
