// The configurations that `chorus init` writes: a comment for each decision, and a pointer to the
// explanation of all other keys.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/environment.h"
#include "common/base/result.h"

namespace chorus::ctl {

/// The options of both services.
struct ServiceWishes {
  std::string address = "0.0.0.0";  ///< The address it listens on.
  std::uint16_t port = 0;
  std::string token;       ///< Role control; empty: none.
  std::string read_token;  ///< Role read, for clients that only read; empty: none.
  std::string tls = {};    ///< Folder of host.crt, host.key, ca.crt; empty: without TLS.
};

struct SensorWishes {
  ServiceWishes service;
  std::string id;
  std::string device = "bridge";  ///< bridge, camera, phone, replay or simulated
  std::string camera = "/dev/video0";
  std::string recording;  ///< The recording that a replay plays.
  std::string socket;     ///< The local socket of a bridge.
  bool images = false;
};

struct PolledWish {
  std::string id;
  std::string url;
  std::string token;  ///< Empty: the sensor needs none.
};

/// An output and its clients: "vrpn" with the addresses that may connect, "dtrack" with its
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

/// Reads "s1=http://10.0.0.11:8081/" or "s1=http://10.0.0.11:8081/,TOKEN"
[[nodiscard]] Result<PolledWish> polled_wish(std::string_view text);

/// Reads "vrpn=10.0.0.20,10.0.0.21", "dtrack=10.0.0.20:5000" or "trackd"
[[nodiscard]] Result<OutputWish> output_wish(std::string_view text);

/// Path of the local socket of the bridge `id`.  `of_the_unit`: in the folder that systemd makes
/// for the unit chorus-sensor.  Otherwise in the user's run folder ($XDG_RUNTIME_DIR), or in /tmp
/// if there is none.
[[nodiscard]] std::string push_socket(const std::string& id, bool of_the_unit,
                                      const Environment& environment);

[[nodiscard]] std::string sensor_config(const SensorWishes& wishes);
[[nodiscard]] std::string fusion_config(const FusionWishes& wishes);

/// 32 random hexadecimal digits that nobody can guess.
[[nodiscard]] std::string new_token();

}  // namespace chorus::ctl
