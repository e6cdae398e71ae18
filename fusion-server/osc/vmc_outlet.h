// Sends people by VMC over UDP.  A VMC performer has one body, so each person has their own
// targets.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/outlet/outlet.h"
#include "fusion-server/outlet/person_targets.h"

namespace chorus::vmc {

struct Settings {
  std::vector<std::string> targets{"127.0.0.1:39539"};
  int slot = 0;                                ///< Slot of the person who is sent to `targets`.
  std::vector<outlet::PersonTargets> persons;  ///< Further persons, with their targets.
  bool trackers = false;                       ///< Adds poses as /VMC/Ext/Tra/Pos.

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::vmc
