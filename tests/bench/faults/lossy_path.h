// A path that delays and loses packets underneath the TCP of this host's kernel: two network
// namespaces with a TUN device each, and a thread that carries packets between them.  What loss
// does to a stream is thus decided by the kernel, not by a model.  Needs root and /dev/net/tun; it
// is not visible outside of this process.
#pragma once

#include <cstdint>
#include <memory>

#include "common/base/result.h"
#include "common/net/asio.h"

namespace chorus::bench {

/// Treatment of each packet, the same in both directions.
struct PacketModel {
  double delay = 0.0;  ///< In one direction [s].
  double loss = 0.0;   ///< 0 to 1
};

class LossyPath {
 public:
  /// Errors: Unsupported (no root, no TUN device), Io.
  [[nodiscard]] static Result<std::unique_ptr<LossyPath>> open(const PacketModel& model);
  ~LossyPath();
  LossyPath(const LossyPath&) = delete;
  LossyPath& operator=(const LossyPath&) = delete;

  /// A listening socket at the far end.
  [[nodiscard]] Result<net::Acceptor> listen_far(asio::io_context& io) const;
  /// A socket at the near end, for connecting to far_address().
  [[nodiscard]] Result<net::Socket> near_socket(asio::io_context& io) const;
  [[nodiscard]] static asio::ip::address_v4 far_address();

  /// Starts or stops losing packets; at first none is lost.
  void lose(bool losing);

 private:
  LossyPath();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::bench
