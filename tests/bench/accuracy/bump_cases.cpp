#include "tests/bench/accuracy/bump_cases.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/base/units.h"
#include "common/synthetic/draw.h"
#include "tests/bench/accuracy/bump_room.h"
#include "tests/bench/methods/over_draws.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr std::uint64_t kBumpPurpose = 731;
constexpr std::size_t kDraws = 20;
constexpr std::size_t kQuickDraws = 1;
constexpr Duration kPushedAt =
    std::chrono::seconds(180);  // by then the watch knows what is usual for each sensor
constexpr Duration kFollowedFor =
    std::chrono::seconds(60);    // after the push; in this time the sensor is registered again
constexpr double kShift = 0.05;  // [m]
constexpr double kTurn = deg(2);
constexpr double kEight = 8.0 * 3600.0;  // [s]
constexpr const char* kProfiles[] = {"A", "B", "D"};

/// What happens to one sensor, in a room with `sensors` sensors.
struct BumpCase {
  const char* name;
  std::size_t sensors;
  double shift;
  double yaw;
};
constexpr BumpCase kBumpCases[] = {{"bump-50mm", 6, kShift, 0.0},
                                   {"bump-2deg", 6, 0.0, kTurn},
                                   {"bump-50mm-three", 3, kShift, 0.0},
                                   {"bump-50mm-pair", 2, kShift, 0.0}};

RoomSetting pushed_room(const BumpCase& each, std::uint64_t seed) {
  synthetic::Draw draw{kBumpPurpose, seed};
  RoomSetting room;
  room.profile = kProfiles[seed % std::size(kProfiles)];
  room.seed = seed;
  room.sensors = each.sensors;
  room.length = kPushedAt + kFollowedFor;
  Push push;
  push.at = kPushedAt;
  push.sensor = draw.bits() % each.sensors;
  const double direction = draw.uniform(-std::numbers::pi, std::numbers::pi);
  push.shift = each.shift * Eigen::Vector3d(std::sin(direction), 0.0, std::cos(direction));
  push.yaw = draw.bits() % 2 == 0 ? each.yaw : -each.yaw;
  room.push = push;
  return room;
}

/// Time from the push to the first alarm that names the sensor, alone or in a pair [s]; NaN: there
/// was none.
double detected_after(const RoomLog& log, const Push& push) {
  for (const RoomLog::Alarm& alarm : log.alarms) {
    if (alarm.sensor == push.sensor && alarm.at >= push.at)
      return chorus::seconds(alarm.at - push.at);
  }
  return kNoRatio;
}

/// Number of false alarms: all before the push, and after it those that name one other sensor
/// alone.
std::size_t wrong_alarms(const RoomLog& log, const Push& push) {
  return static_cast<std::size_t>(
      std::ranges::count_if(log.alarms, [&](const RoomLog::Alarm& alarm) {
        return alarm.at < push.at || (alarm.sensor != push.sensor && !alarm.pair);
      }));
}

struct Told {
  RoomSetting room;
  RoomLog log;
};

void report_pushed(Report& report, const BumpCase& each, const std::vector<Told>& draws) {
  std::vector<double> detected, steps, quiet_steps, placed, again, before, after;
  std::size_t wrong = 0, late = 0;
  constexpr double kSoon = 5.0;  // [s]
  for (const auto& [room, log] : draws) {
    detected.push_back(detected_after(log, *room.push));
    late += !(detected.back() <= kSoon);
    wrong += wrong_alarms(log, *room.push);
    steps.push_back(to_mm(log.step_after));
    quiet_steps.push_back(to_mm(log.step_before));
    before.push_back(to_mm(log.body_error_before));
    after.push_back(to_mm(log.body_error_after));
    if (!log.placed_again) continue;
    placed.push_back(chorus::seconds(*log.placed_again - room.push->at));
    again.push_back(to_mm(log.place_again_error));
  }
  const std::string name = each.name;
  report.row(name, "detect_s", median(detected), "s");
  report.row(name, "detect_95_s", percentile(detected, 0.95), "s");
  report.row(name, "later_than_5s", static_cast<double>(late), "");
  report.row(name, "wrong_alarms", static_cast<double>(wrong), "");
  report.row(name, "largest_step_mm", percentile(steps, 1.0), "mm", "before the push",
             percentile(steps, 1.0) / percentile(quiet_steps, 1.0));
  report.row(name, "body_mm", median(after), "mm", "before the push",
             median(after) / median(before));
  report.row(name, "placed_again", static_cast<double>(placed.size()), "");
  if (placed.empty()) return;
  report.row(name, "placed_again_s", median(placed), "s");
  report.row(name, "placed_again_mm", median(again), "mm");
}

void measure_pushed(Report& report, const BumpCase& each) {
  const auto draws = over_draws(report.quick() ? kQuickDraws : kDraws, [&](std::size_t i) -> Told {
    const RoomSetting room = pushed_room(each, report.seed() + i);
    return {room, live_in(room)};
  });
  report_pushed(report, each, draws);
}

/// Counts the alarms in a room with two people and six sensors, none of which is moved.
void measure_quiet(Report& report) {
  const Duration length = report.quick() ? std::chrono::seconds(60) : std::chrono::seconds(24 * 60);
  const auto logs = over_draws(report.quick() ? kQuickDraws : kDraws, [&](std::size_t i) {
    RoomSetting room;
    room.seed = report.seed() + i;
    room.profile = kProfiles[room.seed % std::size(kProfiles)];
    room.persons = 2;
    room.length = length;
    return live_in(room);
  });
  double alarms = 0.0, walked = 0.0, step = 0.0;
  for (const RoomLog& log : logs) {
    alarms += static_cast<double>(log.alarms.size());
    walked += log.walked;
    step = std::max(step, log.step_before);
  }
  report.row("bump-none", "false_alarms_per_8h", alarms * kEight / walked, "");
  report.row("bump-none", "simulated_hours", walked / 3600.0, "h");
  report.row("bump-none", "largest_step_mm", to_mm(step), "mm");
}

}  // namespace

void measure_bumps(Report& report) {
  for (const BumpCase& each : kBumpCases) measure_pushed(report, each);
  measure_quiet(report);
  report.note(
      "bump: everyday frames after the system's own registration; the sensor is moved within one "
      "frame while one person walks.  detect_s: from there to the alarm.  largest_step_mm: of the "
      "middle of the trunk, from one instant to the next, beyond the true step, from the push to "
      "the end; beside it the same before the push.  wrong_alarms: before the push, or for another "
      "sensor.  Stamps are true time.");
}

}  // namespace chorus::bench
