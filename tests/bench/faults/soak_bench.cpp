// chorus-bench soak: a day of a workshop in one hour.  Sensors restart, a cable falls out, clients
// come and go, walks are registered, recordings are made, all on real processes, and at the end the
// server is killed.  CHORUS_SOAK_SECONDS sets another length than an hour; CHORUS_SOAK_PACE lets
// walks and recordings come so many times as often.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <map>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "common/http/status.h"
#include "tests/bench/faults/sockets.h"
#include "tests/bench/faults/trial.h"
#include "tests/bench/report/report.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr double kRate = 30.0;            // [Hz]
constexpr double kMaxRise = 1.0;          // the claim: memory after the warm-up [MB]
constexpr double kMaxRecover = 1.5;       // the claim: a restarted sensor contributes again [s]
constexpr double kMaxReturn = 1.0;        // the claim: a restarted server answers [s]
constexpr int kWarmUp = 300;              // [s]
constexpr int kMostPace = 10;             // a walk has to end before the next one
constexpr int kRegistrationSeconds = 10;  // of a walk
constexpr const char* kWalks = "device.simulated.scene.reach_m=1.2";
constexpr std::string_view kRequests[] = {
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: application/ld+json\r\n\r\n",
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n",
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
    "GET /sensors/ HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/turtle\r\n\r\n"};

int soak_seconds(const Report& report) {
  constexpr int kHour = 3600;
  constexpr int kQuick = 45;
  const char* asked = std::getenv("CHORUS_SOAK_SECONDS");
  const int length = asked == nullptr ? kHour : std::atoi(asked);
  return report.quick() ? kQuick : std::max(kQuick, length);
}

/// How many times as often as in an ordinary day walks are registered and recordings made.
int soak_pace() {
  const char* asked = std::getenv("CHORUS_SOAK_PACE");
  return asked == nullptr ? 1 : std::clamp(std::atoi(asked), 1, kMostPace);
}

/// Until the server keeps as much history, and as many sessions, as it ever will [s].
int warm_up() { return soak_pace() > 1 ? kWarmUp / 2 : kWarmUp; }

/// Resident memory of the server at some time since the beginning.
struct Memory {
  double time = 0.0;  ///< [s]
  double mb = 0.0;
};

/// By how much the straight line fitted to the samples rises from the first to the last [MB].
double rise_of(const std::vector<Memory>& samples) {
  const auto count = static_cast<double>(samples.size());
  double time = 0.0;
  double mb = 0.0;
  for (const Memory& each : samples) {
    time += each.time / count;
    mb += each.mb / count;
  }
  double product = 0.0;
  double square = 0.0;
  for (const Memory& each : samples) {
    product += (each.time - time) * (each.mb - mb);
    square += (each.time - time) * (each.time - time);
  }
  return square > 0.0 ? product / square * (samples.back().time - samples.front().time) : 0.0;
}

/// Clients that connect, ask once and leave, some 100 each second.
class Visitors {
 public:
  explicit Visitors(std::uint16_t port)
      : thread_([this, port](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            for (const std::string_view request : kRequests)
              ++(head_of_answer({.port = port}, request).empty() ? refused : served);
            wait_for(0.04);
          }
        }) {}
  void leave() {
    thread_.request_stop();
    thread_.join();
  }
  std::atomic<int> served = 0;
  std::atomic<int> refused = 0;

 private:
  std::jthread thread_;
};

/// What happens in the day, and what came of it.
class Day {
 public:
  explicit Day(Cell& cell) : cell_(cell), pace_(soak_pace()) {}

  /// Lets happen what is due at this second.
  Result<void> pass_second(int second);
  /// Ends the last recording, if there is one that runs.
  void end_recording() const {
    if (!recordings.empty()) (void)cell_.ask({"DELETE", "/recordings/" + recordings.back()});
  }

  std::vector<Timestamp> returns;  ///< When a restarted sensor answered again.
  std::vector<Memory> memory;
  int cables = 0;
  int registrations = 0;
  int refused = 0;  ///< Requests that should have been accepted.
  std::vector<std::string> recordings;

 private:
  Result<void> restart_sensor();
  void post(const char* path, const std::string& body, int expected);

  Cell& cell_;
  int pace_;
};

void Day::post(const char* path, const std::string& body, int expected) {
  const auto answer = cell_.ask({"POST", path, {{"Content-Type", "application/json"}}, body});
  if (answer.status == expected) return;
  ++refused;
  fmt::print(stderr, "POST {}: {} {}\n", path, answer.status, answer.body);
}

/// Every fourth time the host's clock is wrong when it comes back, by up to 0.6 s.
Result<void> Day::restart_sensor() {
  const auto turn = static_cast<int>(returns.size());
  if (turn % 4 == 0)
    cell_.change_sensor(1, {kWalks, fmt::format("clock.offset_ms={}", turn / 4 % 7 * 200 - 600)});
  cell_.sensor(1).kill();
  wait_for(0.5);
  if (auto started = cell_.start_sensor(1); !started) return started;
  returns.push_back(now());
  return {};
}

Result<void> Day::pass_second(int second) {
  const auto due = [&](int every, int at) { return second % every == at; };
  if (due(90, 52)) cell_.link(2).freeze(true);
  if (due(90, 54)) {
    cell_.link(2).freeze(false);
    ++cables;
  }
  if (due(150 / pace_, 12 / pace_)) {
    recordings.push_back(fmt::format("soak-{}", second));
    post("/recordings/", nlohmann::json{{"name", recordings.back()}}.dump(),
         http::status::kCreated);
  }
  if (due(150 / pace_, 32 / pace_)) end_recording();
  if (due(300 / pace_, 40 / pace_)) {
    post("/registration", "", http::status::kAccepted);
    ++registrations;
  }
  if (second >= warm_up() && due(5, 0))
    memory.push_back({static_cast<double>(second), cell_.fusion().resident_mb()});
  return due(20, 7) ? restart_sensor() : Result<void>{};
}

/// Four sensors in a folder of their own; the person walks far enough to be registered.
CellPlan plan_of_day(const ScratchFolder& folder) {
  CellPlan plan;
  plan.sensors = 4;
  plan.stored = true;
  plan.links[2] = {};
  for (int i = 0; i < plan.sensors; ++i) plan.of_sensor[i] = {kWalks};
  plan.fusion = {fmt::format("registration.seconds={}", kRegistrationSeconds),
                 "recording.folder=" + folder.path().string()};
  return plan;
}

void report_frames(Report& report, const Account& account) {
  report.row("soak", "output_hz", account.hz, "Hz", "configured", account.hz / kRate);
  report.row("soak", "lost", static_cast<double>(account.lost), "frames");
  report.row("soak", "frames", static_cast<double>(account.frames), "frames");
  report.row("soak", "age_p90_ms", 1e3 * account.age_p90, "ms");
  report.row("soak", "longest_gap_s", account.longest_gap, "s");
  const double others = std::min(account.share_of("s1"), account.share_of("s4"));
  report.row("soak", "others_percent", others, "%");
  report.condition(fmt::format("no instant without its body: {}", account.lost), account.lost == 0);
  report.condition(fmt::format("30.0 Hz: {:.2f}", account.hz), std::abs(account.hz - kRate) < 0.05);
}

void report_returns(Report& report, const Day& day, const std::vector<FusedInstant>& seen) {
  std::vector<double> took;
  for (const Timestamp& since : day.returns) {
    const auto from = std::ranges::lower_bound(seen, since, {}, &FusedInstant::received);
    const auto to =
        std::ranges::lower_bound(seen, since + from_seconds(15.0), {}, &FusedInstant::received);
    took.push_back(recovery({from, to}, since, {"s2"}));
  }
  if (took.empty()) return;
  report.row("soak", "restarts", static_cast<double>(took.size()), "");
  report.row("soak", "recover_s", percentile(took, 0.5), "s");
  report.row("soak", "slowest_recover_s", std::ranges::max(took), "s");
  report.condition(fmt::format("a restarted sensor contributes within {} s: {:.2f} at the latest",
                               kMaxRecover, std::ranges::max(took)),
                   std::ranges::max(took) <= kMaxRecover);
}

void report_memory(Report& report, const Day& day, Cell& cell) {
  report.row("soak", "rss_mb", cell.fusion().resident_mb(), "MB");
  if (day.memory.size() < 2) return;
  const double rise = rise_of(day.memory);
  report.row("soak", "rss_rise_mb", rise, "MB");
  report.condition(
      fmt::format("memory rises by less than {} MB after {} s: {:.2f}", kMaxRise, warm_up(), rise),
      rise < kMaxRise);
}

void report_requests(Report& report, const Day& day, const Cell& cell) {
  int whole = 0;
  for (const std::string& name : day.recordings)
    whole += cell.json("/recordings/" + name).value("state", "") == "finished" ? 1 : 0;
  const auto all = static_cast<int>(day.recordings.size());
  report.row("soak", "recordings", whole, "");
  report.row("soak", "registrations", day.registrations, "");
  report.row("soak", "unplugged", day.cables, "");
  report.condition(fmt::format("{} of {} recordings are whole", whole, all), whole == all);
  report.condition(fmt::format("{} requests were refused", day.refused), day.refused == 0);
}

/// Kills the server: it answers soon, with the registration that it had.
Result<void> kill_server(Report& report, Cell& cell) {
  const auto places = [&] {
    const auto told = cell.json("/registration");
    return told.is_object() ? told.value("sensors", nlohmann::json::object()).size() : 0;
  };
  const std::size_t before = places();
  cell.fusion().kill();
  const Timestamp begun = now();
  if (auto started = cell.start_fusion(); !started) return started;
  const double took = seconds(now() - begun);
  report.row("soak", "server_return_s", took, "s");
  report.condition(fmt::format("the killed server answers within {} s: {:.2f}", kMaxReturn, took),
                   took <= kMaxReturn);
  report.condition(fmt::format("it knows all {} places", before), before > 0 && places() == before);
  return {};
}

}  // namespace

Result<void> run_soak(Report& report) {
  const auto folder = ScratchFolder::make();
  if (!folder) return pass(folder);
  auto cell = Cell::start(plan_of_day(*folder));
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const std::size_t descriptors = cell->fusion().descriptors();
  Visitors visitors(cell->port());
  Day day(*cell);
  const Timestamp begun = now();
  for (int second = 0; second < soak_seconds(report); ++second) {
    if (auto passed = day.pass_second(second); !passed) {  // what was measured so far is told
      report.condition(
          fmt::format("the day goes on after second {}: {}", second, to_string(passed.error())),
          false);
      break;
    }
    wait_for(seconds(begun + from_seconds(second + 1.0) - now()));
  }
  const Timestamp ended = now();
  visitors.leave();
  day.end_recording();
  wait_for(2.0);
  const auto seen = watch.seen();
  report_frames(report, account_of(seen, begun, ended));
  report_returns(report, day, seen);
  report_memory(report, day, *cell);
  report_requests(report, day, *cell);
  report.row("soak", "visitors", visitors.served, "");
  report.condition(fmt::format("{} visitors were refused", visitors.refused.load()),
                   visitors.refused == 0);
  const auto settled = [&] { return cell->fusion().descriptors() <= descriptors; };
  report.condition(fmt::format("no more descriptors than the {} before", descriptors),
                   wait_until(10.0, settled));
  return kill_server(report, *cell);
}

}  // namespace chorus::bench
