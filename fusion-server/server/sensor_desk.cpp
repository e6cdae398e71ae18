#include "fusion-server/server/sensor_desk.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "common/base/file.h"
#include "common/base/log.h"

namespace chorus::server {
namespace {

constexpr std::uintmax_t kMostChangesBytes = 1u << 20;
constexpr std::size_t kMostTrials = 32;
/// Under way at once, one after the other: each takes eight seconds at most.
constexpr std::ptrdiff_t kMostRunning = 4;
/// Finding takes a second or two; an operator waits no longer than this.
constexpr auto kSearch = std::chrono::seconds(6);

}  // namespace

SensorDesk::SensorDesk(SensorDeskOptions options) : options_(std::move(options)) {
  if (options_.folder.empty() || !is_there(path())) return;
  auto stored = read_file(path(), kMostChangesBytes).and_then([](const std::string& text) {
    return read_sensor_changes(text);
  });
  if (stored) {
    changes_ = std::move(*stored);
    return;
  }
  damage_ = to_string(stored.error());
  log::error("sensors that were added on the page are not followed", {{"reason", damage_}});
}

std::string SensorDesk::path() const {
  return (std::filesystem::path(options_.folder) / "sensors.json").string();
}

SensorChanges SensorDesk::changes() const {
  const std::scoped_lock lock(mutex_);
  return changes_;
}

Services SensorDesk::followed(const Services& configured) const {
  SensorChanges now = changes();
  for (auto& sensor : now.added) sensor.trust = options_.trust();
  return followed_of(configured, now);
}

rest::SetupFacts SensorDesk::facts() const {
  const Services configured = options_.configured();
  const std::scoped_lock lock(mutex_);
  rest::SetupFacts facts = told_;
  if (!options_.folder.empty()) facts.file = path();
  facts.text = text_of(changes_, Tokens::Hidden);
  for (const auto& sensor : changes_.added) facts.added.insert(sensor.id.str());
  for (const Services* all : {&configured, &changes_.added}) {
    for (const auto& sensor : *all) {
      if (changes_.silenced.contains(sensor.id)) facts.silenced[sensor.id.str()] = sensor.url;
    }
  }
  return facts;
}

/// Writes the file before the change takes effect: what is followed is what a restart follows.
Result<void> SensorDesk::put(const Change& change) {
  const Services configured = options_.configured();
  {
    const std::scoped_lock lock(mutex_);
    auto next = change(changes_, configured);
    if (!next) return pass(next);
    if (!damage_.empty())
      return fail(ErrorCode::Conflict, "sensors.json",
                  "nothing is changed while this file cannot be read: " + damage_ +
                      "; mend or delete it and restart the server");
    if (!options_.folder.empty()) {
      if (auto kept = replace_file(path(), text_of(*next, Tokens::Written)); !kept)
        return pass(kept);
      std::error_code failed;  // It holds tokens; the folder lets nobody else in anyway.
      std::filesystem::permissions(
          path(), std::filesystem::perms::owner_read | std::filesystem::perms::owner_write, failed);
    }
    changes_ = std::move(*next);
  }
  log::info("sensors changed",
            {{"added", changes().added.size()}, {"silenced", changes().silenced.size()}});
  options_.changed();
  return {};
}

void SensorDesk::search() {
  {
    const std::scoped_lock lock(mutex_);
    if (std::exchange(told_.searching, true)) return;
  }
  worker_.post([this] {
    auto found = client::discovered_sensors({.patience = kSearch});
    const std::scoped_lock lock(mutex_);
    told_.searching = false;
    told_.search_problem = found ? "" : found.error().context + " " + found.error().message;
    if (found) told_.found = std::move(*found);
  });
}

/// Makes room by forgetting an outcome, never a trial that is under way.
Result<void> SensorDesk::begin_trial(const std::string& url) {
  const auto running = [](const auto& trial) { return trial.second.running; };
  const std::scoped_lock lock(mutex_);
  auto& trials = told_.trials;
  const auto same = trials.find(url);
  if (same != trials.end() && same->second.running)
    return fail(ErrorCode::Conflict, "setup/try",
                "this address is being tried already: wait for what comes of it");
  if (std::ranges::count_if(trials, running) >= kMostRunning)
    return fail(ErrorCode::Conflict, "setup/try",
                "other addresses are being tried: try this one when they are done");
  if (same == trials.end() && trials.size() >= kMostTrials)
    trials.erase(std::ranges::find_if_not(trials, running));
  trials[url] = {};
  return {};
}

Result<void> SensorDesk::attempt(const client::FollowedService& sensor) {
  if (auto begun = begin_trial(sensor.url); !begun) return begun;
  worker_.post([this, sensor] {
    auto result = client::try_sensor(sensor.url, sensor.token, options_.trust(), options_.run);
    const std::scoped_lock lock(mutex_);
    if (const auto trial = told_.trials.find(sensor.url); trial != told_.trials.end())
      trial->second = {false, std::move(result)};
  });
  return {};
}

rest::SetupControl SensorDesk::control() {
  rest::SetupControl control;
  control.facts = [this] { return facts(); };
  control.search = [this] { search(); };
  control.attempt = [this](const client::FollowedService& sensor) { return attempt(sensor); };
  control.preview = [this](const Services& more) -> Result<std::string> {
    return with_sensors(changes(), options_.configured(), more).map([](const SensorChanges& next) {
      return text_of(next, Tokens::Hidden);
    });
  };
  control.add = [this](const Services& more) {
    return put([&](SensorChanges now, const Services& configured) {
      return with_sensors(std::move(now), configured, more);
    });
  };
  control.silence = [this](const SensorId& id, bool silent) {
    return put([&](SensorChanges now, const Services& configured) {
      return with_silence(std::move(now), configured, id, silent);
    });
  };
  control.take_out = [this](const SensorId& id) {
    return put([&](SensorChanges now, const Services& configured) {
      return without_sensor(std::move(now), configured, id);
    });
  };
  return control;
}

}  // namespace chorus::server
