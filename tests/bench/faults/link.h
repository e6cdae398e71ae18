// A pump between the two ends of TCP connections on loopback that delays data as a network does: in
// user space, because not every kernel has netem.
//
// Modelled: each message (the result of one read, at most 16 kB) gets its own random delay per
// direction, and none overtakes another, as with TCP. Not modelled: bandwidth, queues and lost
// packets; for those see lossy_path.h, whose sockets a pump can use.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>

#include "common/net/asio.h"

namespace chorus::bench {

/// Delay of one direction; both directions have the same model [s].
struct LinkModel {
  double delay = 0.0;
  double jitter = 0.0;  ///< Additional delay: uniform from 0 to this.
};

/// Where a pump listens and where it connects to.  The functions are called with the pump's
/// io_context.
struct PumpEnds {
  std::function<net::Acceptor(asio::io_context&)> listen;
  std::function<net::Socket(asio::io_context&)> socket;
  net::tcp::endpoint target;
};

/// Ends that are both on loopback: listens on a free port, connects to 127.0.0.1:`target`.
[[nodiscard]] PumpEnds on_loopback(std::uint16_t target);

/// Forwards every connection.
class Pump {
 public:
  Pump(PumpEnds ends, const LinkModel& model, std::uint32_t seed = 1);
  ~Pump();  ///< Cuts all connections.
  Pump(const Pump&) = delete;
  Pump& operator=(const Pump&) = delete;

  [[nodiscard]] std::uint16_t port() const;
  /// Changes the delays, from the next message on.
  void become(const LinkModel& model);
  /// While frozen nothing passes, and neither end is notified, as with an unplugged cable.
  void freeze(bool frozen);
  /// Lets `bytes` more bytes of answers pass; then answers stop until freeze(false).
  void freeze_after(std::size_t bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::bench
