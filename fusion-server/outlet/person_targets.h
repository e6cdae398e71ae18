// Which person is sent to which targets, for protocols with one person per stream.
#pragma once

#include <string>
#include <vector>

#include "common/base/config_reader.h"

namespace chorus::outlet {

struct PersonTargets {
  int slot = 0;  ///< Slot of the person to send.
  std::vector<std::string> targets;

  bool operator==(const PersonTargets&) const = default;
};

/// Reads the key "persons": a list of objects with the keys "slot" and "targets".
void read_persons(ConfigReader& reader, std::vector<PersonTargets>& out);

}  // namespace chorus::outlet
