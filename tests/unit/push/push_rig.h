// A desk whose clocks only move when the test moves them.
#pragma once

#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "services/sensor/device/bridge/push_desk.h"
#include "tests/support/builders.h"

namespace chorus::bridge {

inline const Timestamp kStart = from_unix_ns(1'795'246'200'000'000'000);

struct PushRig {
  explicit PushRig(BridgeSettings settings = {}) {
    DeskOptions options;
    options.sensor = chorus::testing::sensor_id("s1");
    options.settings = std::move(settings);
    options.clock = clock;
    options.steady_now = [now = steady] { return *now; };
    desk = std::make_shared<PushDesk>(std::move(options));
  }
  void pass(Duration time) {
    clock->advance(time);
    *steady += time;
  }
  std::shared_ptr<FakeClock> clock = std::make_shared<FakeClock>(kStart);
  std::shared_ptr<SteadyTime> steady = std::make_shared<SteadyTime>(std::chrono::hours(1));
  std::shared_ptr<PushDesk> desk;
};

/// The captures that were taken since the last call, without what worn sensors said.
inline std::vector<Capture> captures_of(PushDesk& desk) {
  std::vector<Capture> captures;
  for (PushDesk::Pushed& one : desk.pushed(Duration{0})) {
    if (auto* capture = std::get_if<Capture>(&one)) captures.push_back(std::move(*capture));
  }
  return captures;
}

}  // namespace chorus::bridge
