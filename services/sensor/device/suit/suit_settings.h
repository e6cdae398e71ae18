// The configuration section device.suit.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/duration.h"
#include "common/client/followers.h"

namespace chorus::suit {

enum class Transport { Udp, Tcp };

/// A glove that is worn with the suit.
struct GloveFiles {
  std::string hand = {};  ///< The .json that `chorus scan` wrote.
  std::string take = {};  ///< How the hand is held: a .bvh; empty: the suit's own file.
};

struct SuitSettings {
  std::string file = {};  ///< A .mvnx, .htr or .bvh file; empty: the network stream.
  /// Another Chorus service that serves the suit; none: file or stream.
  std::optional<client::FollowedService> service = {};
  bool loop = true;  ///< A file starts again at its end.
  std::string label = {};
  std::string address = "127.0.0.1";  ///< Where the stream is received; numeric.
  int port = 9763;
  Transport transport = Transport::Udp;
  int character = 0;     ///< Which of several people of one stream.
  double stature = 0.0;  ///< Of the person [m]; 0: as the suit's program has measured.
  bool walk = true;      ///< False: takes the place that the suit's own program states.
  Duration latency = std::chrono::milliseconds(20);  ///< From motion to arrival.
  double max_rate_hz = 60.0;
  std::vector<GloveFiles> gloves = {};  ///< At most one for each hand.
};

/// Reads the section; the reader's finish() reports mistakes.
[[nodiscard]] SuitSettings read_suit_settings(ConfigReader& section);

}  // namespace chorus::suit
