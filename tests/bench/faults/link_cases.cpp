// Networks between the sensors and the server that delay, jitter or lose data.
#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tests/bench/faults/trial.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr int kSensors = 4;
constexpr double kHundred = 100.0;
constexpr double kMaxLater = 0.030;  // what one bad link may add to the others' age, p90 [s]

CellPlan with_links(const LinkModel& link, int from, int to) {
  CellPlan plan;
  plan.sensors = kSensors;
  for (int i = from; i < to; ++i) plan.links[i] = link;
  return plan;
}

/// Puts the same link in front of all sensors; each sensor must contribute to nearly all frames.
Result<void> all_alike(Trial& trial, const LinkModel& link) {
  auto cell = Cell::start(with_links(link, 0, kSensors));
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  wait_for(5.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

/// Packets are lost in all directions, and each sensor must still contribute to nearly all frames.
Result<void> lossy(Trial& trial) {
  CellPlan plan;
  plan.sensors = kSensors;
  plan.path = PacketModel{0.005, 0.05};
  auto cell = Cell::start(std::move(plan));
  if (!cell && cell.error().code == ErrorCode::Unsupported)
    return trial.leave_out("network namespaces and TUN devices need root"), Result<void>{};
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  cell->path().lose(true);
  wait_for(5.0);
  const Timestamp begun = now();
  wait_for(30.0);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), cell->placed());
  return {};
}

/// All links are good; then one turns bad, and the others must hardly notice.
Result<Account> one_turns_bad(Trial& trial, Cell& cell, const LinkModel& link) {
  const Watch watch(cell.port());
  wait_for(1.0);
  const Timestamp calm = now();
  wait_for(3.0);
  const Timestamp bad = now();
  cell.link(1).become(link);
  wait_for(7.0);
  const auto seen = watch.seen();
  const Account before = account_of(seen, calm, bad);
  const Account after = account_of(seen, bad + std::chrono::seconds(2), now());
  trial.check_others(cell, after, {"s1", "s3", "s4"});
  const double later = after.age_p90 - before.age_p90;
  trial.check(later <= kMaxLater, fmt::format("age p90 rises by at most 30 ms: {:.0f} to {:.0f} ms",
                                              1e3 * before.age_p90, 1e3 * after.age_p90));
  return after;
}

Result<void> one_bad(Trial& trial, const LinkModel& link) {
  auto cell = Cell::start(with_links({}, 1, 2));
  if (!cell) return pass(cell);
  const auto after = one_turns_bad(trial, *cell, link);
  return after ? Result<void>{} : pass(after);
}

/// Frames too late for the live stream are not lost: instants asked for a second later include
/// them, and /sensors/ reports the share that the sensor really has.
Result<void> used_later(Trial& trial, Cell& cell) {
  constexpr int kAsked = 60;
  constexpr double kMin = 95.0;
  constexpr double kTolerance = 20.0;  // the server counts joints, we count frames [percent]
  const Watch watch(cell.port());
  const Timestamp begun = now();
  int with = 0;
  std::vector<double> shares;
  std::vector<double> afterwards;
  for (int i = 0; i < kAsked; ++i) {
    const Timestamp instant = now() - std::chrono::milliseconds(1000);
    const auto frame = cell.json("/frame?at=" + to_iso8601(instant));
    if (frame.dump().find("s2") != std::string::npos) ++with;
    const auto told = cell.told_of("s2");
    shares.push_back(kHundred * told.value("share", -1.0));
    afterwards.push_back(kHundred * told.value("shareAfterwards", -1.0));
    wait_for(0.05);
  }
  const double used = kHundred * with / kAsked;
  trial.check(used >= kMin,
              fmt::format("?at= one second later uses the late sensor in {:.0f} %", used));
  const double real = account_of(watch.seen(), begun, now()).share_of("s2");
  trial.check(
      std::abs(median(shares) - real) <= kTolerance && median(afterwards) >= kMin - kTolerance,
      fmt::format("it is in {:.0f} % of the frames; /sensors/ says {:.0f} %, {:.0f} % "
                  "afterwards",
                  real, median(shares), median(afterwards)));
  return {};
}

Result<void> jitter_400(Trial& trial) {
  auto cell = Cell::start(with_links({}, 1, 2));
  if (!cell) return pass(cell);
  const auto after = one_turns_bad(trial, *cell, {0.0, 0.4});
  if (!after) return pass(after);
  return used_later(trial, *cell);
}

/// Keeps every core busy in addition to the tracker.
class BusyMachine {
 public:
  BusyMachine() {
    for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
      threads_.emplace_back([](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
        }
      });
  }

 private:
  std::vector<std::jthread> threads_;
};

/// The busy machine delays all frames at times; still, one bad link must not affect the other
/// sensors.
Result<void> jitter_busy(Trial& trial) {
  auto cell = Cell::start(with_links({}, 1, 2));
  if (!cell) return pass(cell);
  const BusyMachine busy;
  const auto after = one_turns_bad(trial, *cell, {0.0, 0.4});
  return after ? Result<void>{} : pass(after);
}

Result<void> unplugged(Trial& trial) {
  auto cell = Cell::start(with_links({}, 1, 2));
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  cell->link(1).freeze(true);
  wait_for(5.0);
  cell->link(1).freeze(false);
  const Timestamp back = now();
  const auto took = [&] { return recovery(watch.seen(), back, cell->placed()); };
  (void)wait_until(8.0, [&] { return std::isfinite(took()); });
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s3", "s4"});
  trial.check_recovery(took(), 1.5);
  return {};
}

RunCase alike(const LinkModel& link) {
  return [link](Trial& trial) { return all_alike(trial, link); };
}
RunCase bad(const LinkModel& link) {
  return [link](Trial& trial) { return one_bad(trial, link); };
}

}  // namespace

FaultCases link_cases() {
  return {
      {"delay-20ms", "20 ms one way to each of four sensors", alike({0.020, 0.0})},
      {"delay-50ms", "50 ms one way to each of four sensors", alike({0.050, 0.0})},
      {"loss-5", "5 ms one way and 5 % of all packets lost between the server and four sensors",
       lossy},
      {"jitter-120ms", "one of four links gets 0 to 120 ms of jitter", bad({0.0, 0.12})},
      {"jitter-400ms", "one of four links gets 0 to 400 ms of jitter", jitter_400},
      {"jitter-busy", "the same, while every core works on something else", jitter_busy},
      {"slow-link", "one of four links takes a second one way", bad({1.0, 0.0})},
      {"unplugged", "one of four links passes nothing for 5 s", unplugged},
  };
}

}  // namespace chorus::bench
