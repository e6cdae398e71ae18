// The configurations that `chorus init` writes: what was decided, each with its comment, and where
// all other keys are explained.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

/// What both services have.
struct ServiceWishes {
  std::string address = "0.0.0.0";  ///< Where it listens.
  std::uint16_t port = 0;
  std::string token;       ///< Role control; empty: none.
  std::string read_token;  ///< Role read, for those who only look; empty: none.
};

struct SensorWishes {
  ServiceWishes service;
  std::string id;
  std::string device = "bridge";  ///< bridge, camera, replay or simulated
  std::string camera = "/dev/video0";
  std::string recording;  ///< Of a replay.
  bool images = false;
};

struct PolledWish {
  std::string id;
  std::string url;
  std::string token;  ///< Empty: the sensor needs none.
};

/// Others that the tracker speaks to: "vrpn" with the addresses that may connect, "dtrack" with its
/// targets.
struct OutputWish {
  std::string name;
  std::vector<std::string> peers;
};

struct FusionWishes {
  ServiceWishes service;
  std::vector<PolledWish> sensors;
  std::vector<OutputWish> outputs;
};

/// "s1=http://10.0.0.11:8081/" or "s1=http://10.0.0.11:8081/,TOKEN"
[[nodiscard]] Result<PolledWish> polled_wish(std::string_view text);

/// "vrpn=10.0.0.20,10.0.0.21", "dtrack=10.0.0.20:5000", "trackd"
[[nodiscard]] Result<OutputWish> output_wish(std::string_view text);

[[nodiscard]] std::string sensor_config(const SensorWishes& wishes);
[[nodiscard]] std::string fusion_config(const FusionWishes& wishes);

/// 32 hexadecimal digits that nobody can guess.
[[nodiscard]] std::string new_token();

}  // namespace chorus::ctl
