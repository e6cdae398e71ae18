// Tries the address of a sensor once and says in words what was found there.
#pragma once

#include <string>

#include "common/tls/credentials.h"

namespace chorus::client {

struct SensorTrial {
  bool good = false;      ///< True: a fusion server can follow what is there.
  std::string words;      ///< What was found, or what is wrong and what to do, as a sentence.
  std::string sensor_id;  ///< What the service calls itself; empty: nothing, or no valid id.
};

/// Asks for the service's description and for its newest frame; blocks for at most a few seconds.
/// Anything but an http(s) URL is a bad trial, never an exception.  Of what the service says the
/// trial keeps its id, the beginning of its title, an HTTP status and the number of people.
/// `own_run`: the run of the server that asks, which its own ETags contain, so that it notices its
/// own address; empty: it serves nothing.
[[nodiscard]] SensorTrial try_sensor(const std::string& url, const std::string& token,
                                     const tls::Trust& trust, const std::string& own_run = {});

}  // namespace chorus::client
