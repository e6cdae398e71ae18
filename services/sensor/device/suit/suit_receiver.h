// Receives the network stream of a suit's program, over UDP or TCP.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <stop_token>

#include "common/base/result.h"
#include "services/sensor/device/suit/suit_settings.h"

namespace chorus::suit {

class SuitReceiver {
 public:
  /// Called with each datagram.
  using Take = std::function<void(std::span<const char> datagram)>;

  /// Opens the socket; the error names the key to change.  Over TCP, the suit's program connects;
  /// one connection at a time, the newest.
  [[nodiscard]] static Result<std::unique_ptr<SuitReceiver>> open(const SuitSettings& settings,
                                                                  Take take);
  ~SuitReceiver();

  [[nodiscard]] std::uint16_t port() const;
  /// Receives on the calling thread until stopped.
  void run(const std::stop_token& stop);

 private:
  struct Impl;
  SuitReceiver();
  std::unique_ptr<Impl> impl_;
};

}  // namespace chorus::suit
