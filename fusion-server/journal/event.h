// Something that happened to the tracker, as people are told of it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/time/timestamp.h"

namespace chorus::journal {

enum class Severity { Calm, Warning, Error };

[[nodiscard]] constexpr std::string_view name_of(Severity severity) {
  switch (severity) {
    case Severity::Calm:
      return "calm";
    case Severity::Warning:
      return "warning";
    case Severity::Error:
      break;
  }
  return "error";
}

struct Event {
  std::uint64_t id = 0;  ///< Given by the log; grows, across restarts too.
  Timestamp time;
  std::string kind;   ///< "sensor-lost", ...: the list is in proto/README.md.
  std::string about;  ///< Id of the sensor or person, name of the output or recording, or empty.
  Severity severity = Severity::Calm;
  std::string message;      ///< A sentence for people.
  std::string advice = {};  ///< What to do; empty if there is nothing to do.

  bool operator==(const Event&) const = default;
};

}  // namespace chorus::journal
