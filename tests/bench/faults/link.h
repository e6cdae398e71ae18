// A pump between two ends of TCP connections on loopback that delays what passes, as a network
// does: a program in user space, since not every kernel has netem.
//
// What it models: every message (what one read yields, at most 16 kB) is delayed by a draw of its
// own per direction, and none overtakes another, as TCP has it.  Loss is what TCP makes of it, with
// the recovery that Linux has (RFC 8985): each segment of 1448 bytes is lost with the given
// probability; a lost one waits for a round trip, among the last three of its message for three
// (tail loss probe), alone in its message or lost again for the retransmission timeout of 200 ms
// and a round trip, doubled with each loss.  Whatever is behind it waits too.  What it does not
// model: bandwidth, queues, lost acknowledgements and handshakes, the congestion window.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <random>

namespace chorus::bench {

/// One way, both directions alike [s].
struct LinkModel {
  double delay = 0.0;
  double jitter = 0.0;  ///< Added, uniform from 0 to this.
  double loss = 0.0;    ///< Of a segment, 0 to 1.
};

/// How long a message of so many bytes is under way [s].
[[nodiscard]] double time_under_way(const LinkModel& link, std::size_t bytes, std::mt19937& random);

/// Listens on a port of its own and hands every connection on to 127.0.0.1:`target`.
class Pump {
 public:
  Pump(std::uint16_t target, const LinkModel& model, std::uint32_t seed = 1);
  ~Pump();  ///< Cuts all connections.
  Pump(const Pump&) = delete;
  Pump& operator=(const Pump&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// From the next message on.
  void become(const LinkModel& model);
  /// From now on nothing passes, and nobody is told: a cable that is out.
  void freeze(bool frozen);
  /// The next answer stops after so many bytes, and everything behind it.
  void freeze_after(std::size_t bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::bench
