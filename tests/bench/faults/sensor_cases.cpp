// Sensors that die, hang and come back; sensors that report impossible data.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>

#include <fmt/format.h>

#include "tests/bench/faults/guest.h"
#include "tests/bench/faults/trial.h"

namespace chorus::bench {
namespace {

constexpr double kReturn = 1.5;    // until a sensor that returns contributes again, at most [s]
constexpr double kFollowed = 0.3;  // the same after its host's clock was set [s]
constexpr double kPatience = 8.0;

/// Waits until all sensors have contributed again for a second, but at most kPatience, which is
/// longer than every limit.
void wait_for_return(const Watch& watch, const Cell& cell, Timestamp since) {
  (void)wait_until(kPatience,
                   [&] { return std::isfinite(recovery(watch.seen(), since, cell.placed())); });
}

Result<void> sensor_killed(Trial& trial) {
  auto cell = Cell::start({});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  cell->sensor(1).kill();
  wait_for(3.0);
  if (auto started = cell->start_sensor(1); !started) return started;
  const Timestamp back = now();
  wait_for_return(watch, *cell, back);
  const auto seen = watch.seen();
  trial.check_others(*cell, account_of(seen, begun, now()), {"s1", "s3"});
  trial.check_recovery(recovery(seen, back, cell->placed()), kReturn);
  return {};
}

Result<void> sensor_stopped(Trial& trial) {
  auto cell = Cell::start({});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  cell->sensor(1).send(SIGSTOP);
  wait_for(4.0);
  trial.check(cell->told_of("s2").value("state", "") != "live", "it is not called live");
  cell->sensor(1).send(SIGCONT);
  const Timestamp back = now();
  wait_for_return(watch, *cell, back);
  const auto seen = watch.seen();
  trial.check_others(*cell, account_of(seen, begun, now()), {"s1", "s3"});
  trial.check_recovery(recovery(seen, back, cell->placed()), kReturn);
  return {};
}

Result<void> frozen_mid_answer(Trial& trial) {
  auto cell = Cell::start({.links = {{1, {}}}});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  cell->link(1).freeze_after(2000);
  wait_for(4.0);
  cell->link(1).freeze(false);
  const Timestamp back = now();
  wait_for_return(watch, *cell, back);
  const auto seen = watch.seen();
  trial.check_others(*cell, account_of(seen, begun, now()), {"s1", "s3"});
  trial.check_recovery(recovery(seen, back, cell->placed()), kReturn);
  return {};
}

/// A bad sensor alongside two good ones, which must not be affected.
struct Beside {
  Neighbour neighbour;
  /// Is set to true once the cell has settled; null: the sensor misbehaves from the start.
  std::atomic<bool>* misbehaves = nullptr;
  double watched = 4.0;   ///< [s]
  bool must_tell = true;  ///< /sensors/ must report an error of the bad sensor.
};

Result<void> beside_two(Trial& trial, const Beside& asked) {
  auto cell = Cell::start({.sensors = 2, .neighbours = {asked.neighbour}, .ring = 3});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  if (asked.misbehaves != nullptr) *asked.misbehaves = true;
  wait_for(asked.watched);
  const auto told = cell->told_of(asked.neighbour.id);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s2"});
  if (!asked.must_tell) return {};
  const std::string state = told.value("state", "");
  const std::string error = told.value("lastError", "");
  trial.check(!error.empty(),
              fmt::format("/sensors/ says what is wrong: {}, \"{}\"", state, error));
  return {};
}

Result<void> garbage(Trial& trial) {
  const RawServer server([](int socket) {
    const std::string noise(5000, '\xff');
    std::array<char, 4096> asked{};
    if (::recv(socket, asked.data(), asked.size(), 0) > 0)
      (void)::send(socket, noise.data(), noise.size(), MSG_NOSIGNAL);
    ::shutdown(socket, SHUT_RDWR);
  });
  return beside_two(trial, {{"x", server.port(), 2, false}});
}

Result<void> never_answers(Trial& trial) {
  const RawServer server([](int socket) {
    std::array<char, 4096> asked{};
    while (::recv(socket, asked.data(), asked.size(), 0) > 0) {
    }
  });
  return beside_two(trial, {{"x", server.port(), 2, false}});
}

/// Turtle about unrelated things: `count` triples of seven bytes each.
std::string foreign_subjects(std::size_t count) {
  std::string text;
  text.reserve(7 * count);
  for (std::size_t i = 0; i < count; ++i) text += "[]a<>.\n";
  return text;
}

Result<void> hour_ahead(Trial& trial) {
  const auto place = place_of(2, 3);
  Guest guest("x", [&](Timestamp when) {
    auto said = honest(place, when);
    said.captured += std::chrono::hours(1);
    for (auto& body : said.bodies) body.captured += std::chrono::hours(1);
    return said;
  });
  return beside_two(trial, {{"x", guest.port(), 2, false}});
}

Result<void> host_at_1970(Trial& trial) {
  const auto place = place_of(2, 3);
  const Timestamp start = now();
  Guest guest("x", [&](Timestamp when) {
    auto said = honest(place, when);
    said.captured = Timestamp(when - start + std::chrono::seconds(5));
    for (auto& body : said.bodies) body.captured = said.captured;
    return said;
  });
  return beside_two(trial, {{"x", guest.port(), 2, false}});
}

Result<void> big_frame(Trial& trial) {
  constexpr std::size_t kSubjects = 270'000;  // 1.9 MB: a reader must still accept it
  const std::string foreign = foreign_subjects(kSubjects);
  const auto place = place_of(2, 3);
  std::atomic<bool> big = false;
  Guest guest("x", [&](Timestamp when) {
    auto said = honest(place, when);
    if (big) said.behind = foreign;
    return said;
  });
  return beside_two(trial, {{"x", guest.port(), 2, false}, &big, 5.0});
}

/// How far a sensor host's clock is ahead of ours, by the stamps on its answers [s].
double clock_ahead(const Cell& cell, int index) {
  const auto answer = ask_port(cell.sensor_port(index), {"GET", "/healthz"});
  const auto stamps = answer.headers.find("chorus-clock");
  if (stamps == answer.headers.end()) return 0.0;
  const std::size_t second = stamps->second.find(' ');  // "<received> <sent>" [ns]
  const auto sent =
      std::strtoll(stamps->second.c_str() + std::min(second, stamps->second.size()), nullptr, 10);
  return seconds(from_unix_ns(sent) - from_unix_ns(answer.received_ns));
}

Result<void> clock_step(Trial& trial, int step_ms) {
  CellPlan plan;
  plan.of_sensor[1] = {fmt::format("clock.step_ms={}", step_ms), "clock.step_after_s=7"};
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  const auto stepped = [&] { return std::abs(clock_ahead(*cell, 1)) > 0.2; };
  trial.check(!stepped() && wait_until(kPatience, stepped), "the clock is set while all watch");
  const Timestamp then = now();
  wait_for_return(watch, *cell, then);
  const auto seen = watch.seen();
  trial.check_others(*cell, account_of(seen, begun, now()), {"s1", "s3"});
  trial.check_recovery(recovery(seen, then, cell->placed()), kFollowed);
  return {};
}

Result<void> clock_step_small(Trial& trial) { return clock_step(trial, 400); }
Result<void> clock_step_back(Trial& trial) { return clock_step(trial, -400); }
Result<void> clock_step_large(Trial& trial) { return clock_step(trial, 5000); }

Result<void> server_first(Trial& trial) {
  auto cell = Cell::start({.start_all = false});
  if (!cell) return pass(cell);
  if (auto started = cell->start_fusion(); !started) return started;
  const Watch watch(cell->port());
  wait_for(4.0);
  for (int i = 0; i < 3; ++i) {
    if (auto started = cell->start_sensor(i); !started) return started;
  }
  const Timestamp there = now();
  wait_for_return(watch, *cell, there);
  trial.check_recovery(recovery(watch.seen(), there, cell->placed()), kReturn);
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

}  // namespace

FaultCases sensor_cases() {
  return {
      {"sensor-killed", "SIGKILL of one of three, back after 3 s", sensor_killed},
      {"sensor-stopped", "SIGSTOP of one of three for 4 s", sensor_stopped},
      {"sensor-frozen", "one stops in the middle of an answer for 4 s", frozen_mid_answer},
      {"sensor-garbage", "one more answers with noise", garbage},
      {"sensor-silent", "one more accepts connections and never answers", never_answers},
      {"big-frame", "one more sends a sound frame and 270 000 subjects of no meaning", big_frame},
      {"hour-ahead", "one more stamps its frames an hour ahead", hour_ahead},
      {"host-1970", "one more believes it is 1970", host_at_1970},
      {"clock-step-400ms", "one of three sets its clock forward by 0.4 s", clock_step_small},
      {"clock-step-back", "one of three sets its clock back by 0.4 s", clock_step_back},
      {"clock-step-5s", "one of three sets its clock forward by 5 s", clock_step_large},
      {"server-first", "the server starts 4 s before its sensors", server_first},
  };
}

}  // namespace chorus::bench
