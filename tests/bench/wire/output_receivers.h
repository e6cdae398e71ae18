// Outputs by the names in the configuration, each with a loopback client that counts its data.
#pragma once

#include <poll.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/sink.h"

namespace chorus::bench {

/// A client of one output.  A unit is a datagram or a message: whatever the protocol sends a fixed
/// number of per frame.
class Receiver {
 public:
  virtual ~Receiver() = default;
  virtual void add_sockets(std::vector<pollfd>& out) const = 0;
  /// Number of units since the last call; does not wait.
  [[nodiscard]] virtual std::size_t read() = 0;
  /// Number of bytes since the beginning.
  [[nodiscard]] virtual std::size_t bytes() const = 0;
};

/// Counts datagrams on a port of its own.
class DatagramReceiver final : public Receiver {
 public:
  DatagramReceiver();
  ~DatagramReceiver() override;
  DatagramReceiver(const DatagramReceiver&) = delete;
  DatagramReceiver& operator=(const DatagramReceiver&) = delete;
  [[nodiscard]] std::uint16_t port() const { return port_; }
  void add_sockets(std::vector<pollfd>& out) const override;
  [[nodiscard]] std::size_t read() override;
  [[nodiscard]] std::size_t bytes() const override { return bytes_; }
  /// Calls `each` for every datagram since the last call; does not wait.
  void take(const std::function<void(std::string_view)>& each) const;
  void say(std::string_view bytes, std::uint16_t to) const;

 private:
  int socket_ = -1;
  std::uint16_t port_ = 0;
  std::size_t bytes_ = 0;
};

struct OpenedOutput {
  std::unique_ptr<Receiver> receiver;
  std::unique_ptr<Sink> sink;
};

struct OutputRow {
  std::string_view name;
  Result<OpenedOutput> (*open)();
};

/// Every output that sends over the network.
[[nodiscard]] const std::vector<OutputRow>& output_rows();

/// The cheapest possible output: it uses the same hand-over and thread, and sends `count`
/// datagrams of `bytes` bytes per frame, whatever the frame contains.
[[nodiscard]] OpenedOutput bare_datagrams(std::size_t count, std::size_t bytes);

}  // namespace chorus::bench
