// The configuration section device.bridge.
#pragma once

#include <cstddef>
#include <string>

#include "common/base/config_reader.h"
#include "common/base/duration.h"

namespace chorus::bridge {

struct BridgeSettings {
  std::string label = "bridge";  ///< Human-readable.
  std::string socket = {};       ///< Path of a local socket; empty: no socket.
  bool page = false;             ///< Serves /capture/ (capture_page.h).
  bool orientations = false;     ///< Takes orientations of worn sensors, too.
  double max_rate_hz = 120.0;    ///< Frames beyond this rate are dropped.
  std::size_t max_message_bytes = 256 * 1024;
  double max_bytes_per_s = 4e6;  ///< A pusher that sends more is disconnected.
  /// Of each way in (WebSocket, local socket) four times as many connections may wait with their
  /// hello; for one more, the oldest of those that said nothing leaves.
  std::size_t max_pushers = 4;
  /// A pusher that pushes no frame for this long makes room for another one.
  Duration yields_after = std::chrono::seconds(2);
};

/// Reads the section; the reader's finish() reports mistakes.
[[nodiscard]] BridgeSettings read_bridge_settings(ConfigReader& section);

}  // namespace chorus::bridge
