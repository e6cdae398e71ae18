// What operators changed about the sensors while the server ran: sensors that they added, and
// sensors that they silenced.  It is kept as sensors.json in the state folder, in the syntax of the
// configuration's section "sensors"; the configuration itself is never written to:
//
//   { "sensors": [ { "id": "s3", "url": "http://10.0.0.3:8081/", "token": "..." } ],
//     "silenced": [ "s1" ] }
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/client/followers.h"

namespace chorus::server {

using Services = std::vector<client::FollowedService>;

struct SensorChanges {
  Services added;
  std::set<SensorId> silenced;

  bool operator==(const SensorChanges&) const = default;
};

/// Reads the file's text; the sensors trust no authority yet.  All mistakes are one Error.
[[nodiscard]] Result<SensorChanges> read_sensor_changes(const std::string& text);

enum class Tokens { Written, Hidden };
/// The file's text; for people to look at with Tokens::Hidden.
[[nodiscard]] std::string text_of(const SensorChanges& changes, Tokens tokens);

/// The changes with these sensors added.  Conflict if an id or an address is taken, also by one of
/// the `configured` ones; TooLarge beyond kMaxSensors.
[[nodiscard]] Result<SensorChanges> with_sensors(SensorChanges changes, const Services& configured,
                                                 const Services& more);
/// The changes without an added sensor.  Conflict for one of the `configured` ones, which only the
/// configuration can take out; NotFound if nobody has the id.
[[nodiscard]] Result<SensorChanges> without_sensor(SensorChanges changes,
                                                   const Services& configured, const SensorId& id);
/// The changes with a sensor silenced or heard again; NotFound if nobody has the id.
[[nodiscard]] Result<SensorChanges> with_silence(SensorChanges changes, const Services& configured,
                                                 const SensorId& id, bool silent);

/// The configured sensors, then the added ones whose id the configuration lacks, all but the
/// silenced ones.
[[nodiscard]] Services followed_of(const Services& configured, const SensorChanges& changes);

}  // namespace chorus::server
