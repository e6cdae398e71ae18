// What the journal looks at, several times a second.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fusion-server/journal/roll.h"
#include "fusion-server/sink.h"
#include "fusion-server/status/server_status.h"

namespace chorus::journal {

struct RecordingGlimpse {
  std::string name;
  std::string trouble = {};  ///< Why it ended by itself; empty if it did not.
  bool running = false;
};

struct Glimpse {
  Timestamp time;
  std::vector<SensorStatus> sensors;
  Registration registration;
  std::vector<SessionStatus> sessions;  ///< Newest first.
  bool proposal = false;                ///< A registration waits to be accepted.
  std::string storage_trouble = {};
  std::vector<OutputStatus> outputs;
  std::optional<RecordingGlimpse> recording;  ///< The newest one of this run.
  /// Free bytes on the disk for recordings, and how many a recording leaves free; none: nothing is
  /// recorded.
  std::optional<double> disk_free = {};
  double disk_least = 0.0;
  std::vector<KnownPerson> people;
};

}  // namespace chorus::journal
