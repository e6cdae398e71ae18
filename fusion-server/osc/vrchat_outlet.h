// Sends persons as VRChat OSC trackers over UDP, each to targets of its own.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"
#include "fusion-server/outlet/person_targets.h"

namespace chorus::vrchat {

struct Settings {
  std::vector<std::string> targets{"127.0.0.1:9000"};
  int slot = 0;                                ///< Whose person.
  std::vector<outlet::PersonTargets> persons;  ///< More.
  bool head = true;  ///< Also the head, by which VRChat aligns its space with ours.

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::vrchat
