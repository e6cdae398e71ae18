// Outputs by the names of their configuration, each with a loopback client that counts what comes.
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

/// A client of one output.  A unit is what the protocol sends a fixed number of per frame: a
/// datagram, or a message.
class Receiver {
 public:
  virtual ~Receiver() = default;
  virtual void add_sockets(std::vector<pollfd>& out) const = 0;
  /// Units that have come since the last call; does not wait.
  [[nodiscard]] virtual std::size_t read() = 0;
  /// Bytes since the beginning.
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
  /// Each that has come since the last call, for receivers that look into them; does not wait.
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

/// Every output that somebody can connect to; one more is one more row.
[[nodiscard]] const std::vector<OutputRow>& output_rows();

/// The least that an output can be: the same hand-over and thread, and so many datagrams of so many
/// bytes per frame, whatever is in it.
[[nodiscard]] OpenedOutput bare_datagrams(std::size_t count, std::size_t bytes);

}  // namespace chorus::bench
