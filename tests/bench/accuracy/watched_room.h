// A room in everyday use as the watch sees it: the people of each tenth of a second with all views
// of them, as association makes them of simulated frames and of the system's own registration.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fusion-server/flow/person.h"
#include "tests/judge/judge.h"

namespace chorus::bench {

struct WatchedSetting {
  std::string profile = "A";
  std::uint64_t seed = 1;
  std::size_t sensors = 6;
  std::size_t persons = 1;
  Duration length = std::chrono::seconds(60);
  std::vector<synthetic::Occluder> things = {};  ///< Put into the room after the registration.
};

using TakePeople = std::function<void(const std::vector<Person>& people, Timestamp instant)>;

/// Registers the sensors by a walk of one person (30 s), then runs the room for `length` and hands
/// over what is seen at each instant.
void watch_room(const WatchedSetting& setting, const TakePeople& take);

}  // namespace chorus::bench
