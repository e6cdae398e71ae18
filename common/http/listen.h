// Where a server listens for TCP, and what keeps it accepting.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "common/base/rate_report.h"
#include "common/base/result.h"
#include "common/http/asio.h"

namespace chorus::http {

struct ListenAt {
  std::string address;  ///< Numeric.
  std::uint16_t port = 0;
  std::string_view port_key;  ///< What to change when the port is taken: "http.port".
};

/// What is said of an address that is not numeric: InvalidArgument.
[[nodiscard]] Result<net::ip::address> numeric_address(const ListenAt& where);

/// Io names address and port, and the key to change when that would help.  `transport` is TCP or
/// UDP.
[[nodiscard]] tl::unexpected<Error> cannot_listen(const ListenAt& where, std::string_view transport,
                                                  error_code failed);

/// Opens, binds and listens; what an acceptor had open before is closed.
[[nodiscard]] Result<void> listen_on(Acceptor& acceptor, const ListenAt& where);

/// Accepts connections until it is stopped.  When the system cannot give one (no descriptors left)
/// that is reported and tried again after a pause; what `welcome` throws costs that connection
/// alone.  Lives on the io_context's thread.
class AcceptLoop {
 public:
  using Welcome = std::function<void(Socket)>;

  /// `trouble` names what is logged: "VRPN accept failed".
  AcceptLoop(net::io_context& io, std::string trouble, Welcome welcome);

  [[nodiscard]] Result<void> listen(const ListenAt& where) { return listen_on(acceptor_, where); }
  [[nodiscard]] std::uint16_t port() const;

  /// Starts it; does nothing while it is under way, so run_events may call it again and again.
  void ensure();
  void stop();

 private:
  void accept();
  void on_accepted(error_code failed, Socket socket);
  void pause();

  Acceptor acceptor_;
  Timer timer_;
  RateReport trouble_;
  Welcome welcome_;
  bool under_way_ = false;
  bool stopped_ = false;
};

}  // namespace chorus::http
