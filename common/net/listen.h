// Listening for TCP, and accepting connections until stopped.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/rate_report.h"
#include "common/base/result.h"
#include "common/net/asio.h"

namespace chorus::net {

struct ListenAt {
  std::string address;  ///< Must be numeric.
  std::uint16_t port = 0;
  std::string_view port_key;  ///< The key to change when the port is taken: "http.port".
};

/// The address of `where`; InvalidArgument when it is not numeric.
[[nodiscard]] Result<asio::ip::address> numeric_address(const ListenAt& where);

/// An Io error with address and port and, when changing the port would help, with its key.
/// `transport` is TCP or UDP.
[[nodiscard]] tl::unexpected<Error> cannot_listen(const ListenAt& where, std::string_view transport,
                                                  error_code failed);

/// Opens, binds and listens; first closes what the acceptor had open.
[[nodiscard]] Result<void> listen_on(Acceptor& acceptor, const ListenAt& where);

/// Accepts connections until it is stopped.  If accepting fails, for example because the system has
/// no descriptors left, it logs that and tries again after a pause.  An exception from `welcome`
/// costs only that connection.  Runs on the io_context's thread.
class AcceptLoop {
 public:
  using Welcome = std::function<void(Socket)>;

  /// `trouble`: the name of the event that logs failures, such as "VRPN accept failed".
  AcceptLoop(asio::io_context& io, std::string trouble, Welcome welcome);

  [[nodiscard]] Result<void> listen(const ListenAt& where) { return listen_on(acceptor_, where); }
  [[nodiscard]] std::uint16_t port() const;

  /// Starts accepting unless that is already running, so run_events() may call this repeatedly.
  void ensure();
  void stop();

 private:
  void accept();
  void on_accepted(error_code failed, Socket socket);
  void take_more(std::vector<Socket>& all);
  void pause();

  Acceptor acceptor_;
  Timer timer_;
  RateReport trouble_;
  Welcome welcome_;
  bool under_way_ = false;
  bool stopped_ = false;
};

}  // namespace chorus::net
