// A VRPN server on a free port, and people for it to report.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "fusion-server/vrpn/vrpn_server.h"
#include "tests/support/builders.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::vrpn::test {

inline constexpr std::size_t kSlots = 6;

inline outlet::TrackerFrame persons(std::size_t count, std::uint64_t sequence = 1) {
  outlet::TrackerFrame frame;
  frame.sequence = sequence;
  frame.instant = chorus::testing::kStart + std::chrono::milliseconds(sequence);
  frame.slots = kSlots;
  for (std::size_t slot = 0; slot < count; ++slot) {
    outlet::TrackerBody body;
    body.slot = slot;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      body.joints[i].tracked = true;
      body.joints[i].position = {static_cast<double>(slot), static_cast<double>(i),
                                 static_cast<double>(sequence)};
    }
    frame.bodies.push_back(body);
  }
  return frame;
}

class VrpnRig : public ::testing::Test {
 protected:
  void serve(ServerOptions options = {}) {
    options.port = 0;
    if (!options.clock) options.clock = std::make_shared<SystemClock>();
    server.emplace(std::move(options), trackers);
    const auto started = server->start();
    ASSERT_TRUE(started) << to_string(started.error());
  }
  void publish(std::size_t count, std::uint64_t number) {
    server->publish(std::make_shared<const Reports>(encode(persons(count, number), *trackers)));
  }
  /// Publishes every few ms until the condition holds, up to a generous time limit.
  bool publish_until(const std::function<bool()>& holds, std::size_t count = 1) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!holds()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      publish(count, ++sequence);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }
  bool wait_until(const std::function<bool()>& holds) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!holds() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return holds();
  }

  std::shared_ptr<const Trackers> trackers = std::make_shared<const Trackers>(kSlots, true);
  std::optional<Server> server;
  std::uint64_t sequence = 100;
};

}  // namespace chorus::vrpn::test
