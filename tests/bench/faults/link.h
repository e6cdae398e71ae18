// A pump between two ends of TCP connections on loopback that delays what passes, as a network
// does: a program in user space, since not every kernel has netem.
//
// What it models: every message (what one read yields, at most 16 kB) is delayed by a draw of its
// own per direction, and none overtakes another, as TCP has it.  What it does not model: bandwidth,
// queues and lost packets; those are for lossy_path.h, whose sockets a pump can use.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

#include "common/net/asio.h"

namespace chorus::bench {

/// One way, both directions alike [s].
struct LinkModel {
  double delay = 0.0;
  double jitter = 0.0;  ///< Added, uniform from 0 to this.
};

/// Where a pump listens and to what it connects.  Made on the pump's io_context.
struct PumpEnds {
  std::function<net::Acceptor(asio::io_context&)> listen;
  std::function<net::Socket(asio::io_context&)> socket;
  net::tcp::endpoint target;
};

/// Both on loopback: a port of its own, and 127.0.0.1:`target`.
[[nodiscard]] PumpEnds on_loopback(std::uint16_t target);

/// Hands every connection on.
class Pump {
 public:
  Pump(PumpEnds ends, const LinkModel& model, std::uint32_t seed = 1);
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
