// The sockets of one client.  Lives on the server's thread.
#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "common/base/rate_report.h"
#include "common/net/asio.h"
#include "common/time/clock.h"
#include "fusion-server/vrpn/request_gate.h"
#include "fusion-server/vrpn/vrpn_conversation.h"

namespace chorus::vrpn {

/// Incremented on the server's thread, read on any.
struct ServerCounters {
  std::atomic<std::uint64_t> dropped = 0;  ///< Number of frames, counted per client.
  std::atomic<std::uint64_t> failed = 0;   ///< Number of datagrams.
  std::atomic<std::uint64_t> refused = 0;  ///< Number of clients and requests.
  std::atomic<std::uint64_t> clients = 0;
};

struct ClientLimits {
  std::chrono::milliseconds handshake{5000};  ///< Time limit for the client's cookie.
  std::chrono::milliseconds stall{5000};      ///< Longest that one write may take.
};

/// Used by all connections of a server; outlives them.
struct ConnectionContext {
  net::DatagramSocket* datagrams = nullptr;
  const Clock* clock = nullptr;
  ServerCounters* counters = nullptr;
  RateReport* turned_away = nullptr;
  ClientLimits limits;
};

/// A client that does not read costs one frame of memory: while a write is in progress only the
/// newest frame waits, and older ones are dropped; after ClientLimits::stall the client is closed.
/// Its answers are limited, too: while kMaxAnswers are waiting, nothing more is read from it.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Closed = std::function<void(const Connection*)>;

  Connection(ConnectionContext context, net::Socket socket, Conversation conversation,
             Closed closed);

  void start();
  void publish(const std::shared_ptr<const Reports>& reports);
  /// Closes the connection when a deadline has passed.
  void sweep(SteadyTime now);
  void close();

 private:
  static constexpr std::size_t kMaxAnswers = 65536;

  void read();
  void on_read(net::error_code failed, std::size_t size);
  void write();
  void on_written(net::error_code failed);
  void send_datagrams(const Reports& reports);
  void refuse(const std::string& reason);

  ConnectionContext context_;
  net::Socket socket_;
  net::udp::endpoint datagrams_to_;
  Conversation conversation_;
  Closed closed_;
  std::array<char, 4096> input_{};
  bool reading_ = false;
  std::string answers_;                     ///< Answers to be written before the next frame.
  std::shared_ptr<const Reports> waiting_;  ///< The newest frame not written yet.
  std::string output_;                      ///< Data being written.
  bool writing_ = false;
  SteadyTime deadline_;  ///< For the cookie; later, for the write in progress.
};

}  // namespace chorus::vrpn
