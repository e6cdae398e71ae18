// Sends people as VRChat OSC trackers over UDP; each person has their own targets.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/config_reader.h"
#include "common/base/result.h"
#include "fusion-server/osc/vrchat_encoder.h"
#include "fusion-server/outlet/outlet.h"
#include "fusion-server/outlet/person_targets.h"

namespace chorus::vrchat {

struct Settings {
  std::vector<std::string> targets{"127.0.0.1:9000"};
  int slot = 0;                                ///< Slot of the person who is sent to `targets`.
  std::vector<outlet::PersonTargets> persons;  ///< Further persons, with their targets.
  bool head = true;  ///< Adds the head, which VRChat uses to align its space with ours.

  /// Of everybody's trackers, those that are things in hands.
  std::vector<PropTracker> prop_trackers = {};

  bool operator==(const Settings&) const = default;
};

void read_settings(ConfigReader& reader, Settings& out);

[[nodiscard]] Result<std::unique_ptr<outlet::Outlet>> open_outlet(
    const Settings& settings, const outlet::OutletContext& context);

}  // namespace chorus::vrchat
