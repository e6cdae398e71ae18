// The sockets of one client; runs on the server's thread.
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

/// Written on the server's thread, read on any.
struct ServerCounters {
  std::atomic<std::uint64_t> dropped = 0;  ///< Frames that were dropped, counted for each client.
  std::atomic<std::uint64_t> failed = 0;   ///< Datagrams that could not be sent.
  std::atomic<std::uint64_t> refused = 0;  ///< Clients and requests that were refused.
  std::atomic<std::uint64_t> clients = 0;
};

struct ClientLimits {
  std::chrono::milliseconds handshake{5000};  ///< Time limit for the client's cookie.
  std::chrono::milliseconds stall{5000};      ///< Longest time that one write may take.
};

/// Shared by all connections of a server, and outlives them.
struct ConnectionContext {
  net::DatagramSocket* datagrams = nullptr;
  const Clock* clock = nullptr;
  ServerCounters* counters = nullptr;
  RateReport* turned_away = nullptr;
  ClientLimits limits;
};

/// A client that does not read costs memory for one frame only: while a write is in progress, only
/// the newest frame waits, and older ones are dropped; after ClientLimits::stall the client is
/// disconnected.  Its answers are limited too: while kMaxAnswers bytes of them or more are waiting,
/// nothing is read from it.
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
  /// Counts and logs the reason, and closes.
  void refuse(const std::string& reason);

  /// True once the client's cookie has arrived.
  [[nodiscard]] bool established() const { return conversation_.established(); }
  /// When the client last said anything; when it connected, if it never did.
  [[nodiscard]] SteadyTime heard() const { return heard_; }

 private:
  static constexpr std::size_t kMaxAnswers = 65536;

  void read();
  void on_read(net::error_code failed, std::size_t size);
  void write();
  void on_written(net::error_code failed);
  void send_datagrams(const Reports& reports);

  ConnectionContext context_;
  net::Socket socket_;
  net::udp::endpoint datagrams_to_;
  Conversation conversation_;
  Closed closed_;
  std::array<char, 4096> input_{};
  bool reading_ = false;
  std::string answers_;                     ///< Answers that are written before the next frame.
  std::shared_ptr<const Reports> waiting_;  ///< The newest frame that has not been written.
  std::string output_;                      ///< The bytes being written.
  bool writing_ = false;
  SteadyTime heard_ = std::chrono::steady_clock::now();
  SteadyTime deadline_;  ///< For the cookie; later for the write in progress.
};

}  // namespace chorus::vrpn
