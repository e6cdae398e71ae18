// Tries the address of a sensor once and says in words what was found there.
#pragma once

#include <string>

#include "common/tls/credentials.h"

namespace chorus::client {

struct SensorTrial {
  bool good = false;      ///< True: a fusion server can follow what is there.
  std::string words;      ///< What was found, or what is wrong and what to do, as a sentence.
  std::string sensor_id;  ///< What the service calls itself; empty: it does not say.
};

/// Asks for the service's description and for its newest frame; blocks for at most a few seconds.
/// Anything but an http(s) URL is a bad trial, never an exception.
[[nodiscard]] SensorTrial try_sensor(const std::string& url, const std::string& token,
                                     const tls::Trust& trust);

}  // namespace chorus::client
