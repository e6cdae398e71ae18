// A worn suit that falls silent, floods, lies or slips, beside two sensors that see its wearer.
#include <csignal>

#include <fmt/format.h>

#include "tests/bench/faults/trial.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

constexpr double kSuitPatience = 15.0;   // for its start on a busy machine [s]
constexpr double kFollowedAgain = 10.0;  // until a source that comes back is called live [s]
constexpr double kMostDocuments = 55.0;  // a second; services say at most 50, and rates are rounded

/// A suit of 13 sensors as a process of its own, and the cell that follows it.
struct SuitCell {
  ChildProcess suit;
  Cell cell;

  [[nodiscard]] nlohmann::json told() const {
    const auto list = cell.json("/inertial/").value("inertialSources", nlohmann::json::array());
    return list.empty() ? nlohmann::json::object() : list.front();
  }
  [[nodiscard]] std::string state() const { return told().value("state", ""); }
};

Result<SuitCell> suit_cell(const Settings& of_suit) {
  const std::uint16_t port = testing::free_port();
  Settings settings{"id=suit",
                    fmt::format("http.port={}", port),
                    "device.kind=inertial",
                    "device.inertial.source=simulated",
                    "device.inertial.scene.reach_m=0.5",
                    "device.inertial.skin=1"};
  settings.insert(settings.end(), of_suit.begin(), of_suit.end());
  auto suit = ChildProcess::start("chorus-sensor", words_of("deploy/config/sensor.json", settings));
  if (!suit) return pass(suit);
  if (!wait_until(kSuitPatience, [&] {
        return ask_port(port, {"GET", "/orientations"}).status == 200;
      }))
    return fail(ErrorCode::Timeout, "the suit", "does not answer on /orientations");
  CellPlan plan{.sensors = 2};
  plan.fusion = {fmt::format(R"(inertial=[{{"id":"suit","url":"http://127.0.0.1:{}/"}}])", port)};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  return SuitCell{std::move(*suit), std::move(*cell)};
}

/// Watches for a while; the two sensors and the fused frames must not suffer.
void watch_both(Trial& trial, SuitCell& both, double length) {
  const Watch watch(both.cell.port());
  wait_for(1.0);
  const Timestamp begun = now();
  wait_for(length);
  trial.check_others(both.cell, account_of(watch.seen(), begun, now()), {"s1", "s2"});
}

/// A suit whose sensors err on purpose from the tenth second on, when they are calibrated.
Result<void> suit_that_errs(Trial& trial, const std::string& fault) {
  auto both = suit_cell({"device.inertial.faults=[" + fault + "]"});
  if (!both) return pass(both);
  watch_both(trial, *both, 15.0);
  trial.check(both->state() == "live", "the suit itself is followed on: " + both->state());
  return {};
}

Result<void> suit_slips(Trial& trial) {
  return suit_that_errs(trial,
                        R"({"kind":"slip","limb":"ForearmLeft","begin_s":10,"size_deg":60})");
}
Result<void> suit_swapped(Trial& trial) {
  return suit_that_errs(trial,
                        R"({"kind":"swap","limb":"ShankLeft","other":"ShankRight","begin_s":10})");
}
Result<void> suit_lies(Trial& trial) {
  return suit_that_errs(trial, R"({"kind":"lie","limb":"ForearmLeft","begin_s":0,"factor":0.01},
                {"kind":"lie","limb":"ThighLeft","begin_s":0,"factor":100})");
}
Result<void> suit_sensors_silent(Trial& trial) {
  return suit_that_errs(trial, R"({"kind":"battery","limb":"ShankLeft","begin_s":8},
                                  {"kind":"silence","limb":"Pelvis","begin_s":9})");
}

Result<void> suit_silent(Trial& trial) {
  auto both = suit_cell({});
  if (!both) return pass(both);
  both->suit.send(SIGSTOP);
  watch_both(trial, *both, 4.0);
  trial.check(both->state() != "live", "it is not called live: " + both->state());
  both->suit.send(SIGCONT);
  trial.check(wait_until(kFollowedAgain, [&] { return both->state() == "live"; }),
              "it is followed again");
  return {};
}

Result<void> suit_floods(Trial& trial) {
  // Without skin, or simulating it would take half a core away from everybody.
  auto both = suit_cell({"device.inertial.rate_hz=1000", "device.inertial.skin=0"});
  if (!both) return pass(both);
  watch_both(trial, *both, 5.0);
  const double rate = both->told().value("rateHz", 0.0);
  trial.check(
      rate > 1.0 && rate <= kMostDocuments,
      fmt::format("a thousand instants come in at most 50 documents a second: {:.0f}", rate));
  return {};
}

Result<void> suit_clock(Trial& trial) {
  auto both = suit_cell({"clock.step_ms=5000", "clock.step_after_s=8"});
  if (!both) return pass(both);
  watch_both(trial, *both, 10.0);
  const auto followed = [&] {
    const auto told = both->told();
    return told.value("state", "") == "live" &&
           std::abs(told.value("clockOffsetMilliseconds", 0.0) + 5000.0) < 200.0;
  };
  trial.check(wait_until(kFollowedAgain, followed),
              "its new time is followed: " + both->told().dump());
  return {};
}

}  // namespace

FaultCases inertial_cases() {
  return {
      {"suit-silent", "SIGSTOP of a followed suit for 5 s", suit_silent},
      {"suit-floods", "a suit of 13 sensors says a thousand instants a second", suit_floods},
      {"suit-clock", "a suit's clock is set forward by 5 s", suit_clock},
      {"suit-sensors-silent", "a sensor's battery dies, and another falls silent",
       suit_sensors_silent},
      {"suit-swapped", "the sensors of both shanks are exchanged", suit_swapped},
      {"suit-slips", "the sensor of a forearm slips by 60 degrees", suit_slips},
      {"suit-lies", "two sensors state a hundredth and a hundred times their error", suit_lies},
  };
}

}  // namespace chorus::bench
