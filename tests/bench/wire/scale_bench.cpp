// chorus-bench scale: measures what sensors, people and readers cost the fusion server, one after
// the other as a curve, and what 3 000 readers behind a proxy do to it.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "tests/bench/live/live_cell.h"
#include "tests/bench/live/nginx_proxy.h"
#include "tests/bench/report/report.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

using Steady = std::chrono::steady_clock;

constexpr double kRate = 30.0;       // [Hz]
constexpr double kMinShare = 0.99;   // fraction of frames that readers get on average
constexpr double kMaxRatio = 1.3;    // the claim: cost of a WebSocket over that of an event stream
constexpr double kMaxOfACore = 0.2;  // the claim: 64 sensors, one person
constexpr int kReaders = 300;
constexpr auto kWarmUp = std::chrono::seconds(2);

/// Processor time of a program during `run_seconds`, as a fraction of one core.
double cores_used(const ChildProcess& program, double run_seconds) {
  const auto begun = Steady::now();
  const double before = program.cpu_seconds();
  std::this_thread::sleep_for(std::chrono::duration<double>(run_seconds));
  const double used = program.cpu_seconds() - before;
  return used / std::chrono::duration<double>(Steady::now() - begun).count();
}

double cores_used(const LiveCell& cell, double run_seconds) {
  return cores_used(cell.fusion.front(), run_seconds);
}

struct Reading {
  double cores = 0.0;     ///< Cores used by the server.
  double hz = 0.0;        ///< Frames per second that a reader received, on average.
  double least_hz = 0.0;  ///< Of the reader that received the fewest; its share of the last frame
                          ///< counts as one.
  std::uint64_t lost = 0;
};

Reading read_by(const LiveCell& cell, const ClientCounts& clients, double run_seconds) {
  const ClientCrowd crowd(cell, clients);
  std::this_thread::sleep_for(kWarmUp);
  const auto begun = Steady::now();
  const ClientAnswers before = crowd.answers();
  Reading out;
  out.cores = cores_used(cell, run_seconds);
  const ClientAnswers after = crowd.answers();
  const double elapsed = std::chrono::duration<double>(Steady::now() - begun).count();
  const auto got = after.events - before.events + after.messages - before.messages;
  out.hz = static_cast<double>(got) / elapsed / static_cast<double>(before.of_each.size());
  out.least_hz = static_cast<double>(fewest(before, after) + 1) / elapsed;
  out.lost = after.lost;
  return out;
}

void report_reading(Report& report, const std::string& name, const Reading& reading) {
  report.row(name, "fusion_cores", reading.cores, "cores");
  report.row(name, "client_hz", reading.hz, "Hz");
  report.row(name, "slowest_client_hz", reading.least_hz, "Hz");
  report.row(name, "connections_lost", static_cast<double>(reading.lost), "connections");
  report.condition(name + ": every reader gets every frame",
                   reading.least_hz > kMinShare * kRate && reading.lost == 0);
}

/// Measures the cost of the readers [cores]: what the server uses without them is subtracted.
Result<void> readers_300(Report& report, double run_seconds) {
  const auto cell = start_cell(3, 6);
  if (!cell) return pass(cell);
  std::this_thread::sleep_for(kWarmUp);
  const double alone = cores_used(*cell, run_seconds);
  const Reading events = read_by(*cell, {.event_streams = kReaders}, run_seconds);
  const Reading sockets = read_by(*cell, {.websockets = kReaders}, run_seconds);
  const double ratio = (sockets.cores - alone) / (events.cores - alone);
  report.row("events-0", "fusion_cores", alone, "cores");
  report_reading(report, "events-300", events);
  report_reading(report, "websockets-300", sockets);
  report.row("websockets-300", "readers_cores", sockets.cores - alone, "cores", "events-300",
             ratio);
  report.condition("websockets-300: at most 1.3 x the same event streams", ratio <= kMaxRatio);
  return {};
}

/// What the server alone uses for so many sensors and people, and whether it holds 30 Hz.
struct Load {
  double cores = 0.0;
  double hz = 0.0;
  std::uint64_t lost = 0;
  double rss_mb = 0.0;
};

Result<Load> load_of(int sensors, int persons, double run_seconds) {
  const auto cell = start_cell(sensors, persons);
  if (!cell) return pass(cell);
  std::this_thread::sleep_for(kWarmUp);
  Load out;
  out.cores = cores_used(*cell, run_seconds);
  const auto seen = watch(*cell, run_seconds / 2);
  if (!seen) return pass(seen);
  out.hz = seen->output_hz;
  out.lost = seen->lost;
  out.rss_mb = cell->fusion.front().resident_mb();
  return out;
}

void report_load(Report& report, const std::string& name, const Load& load) {
  report.row(name, "fusion_cores", load.cores, "cores");
  report.row(name, "output_hz", load.hz, "Hz", "configured", load.hz / kRate);
  report.row(name, "lost_frames", static_cast<double>(load.lost), "frames");
  report.row(name, "rss_mb", load.rss_mb, "MB");
  report.condition(name + ": nothing lost", load.lost == 0);
}

Result<void> sensors(Report& report, double run_seconds) {
  for (const int count : {1, 4, 16, 32, 64}) {
    const auto load = load_of(count, 1, run_seconds);
    if (!load) return pass(load);
    const std::string name = fmt::format("sensors-{}", count);
    report_load(report, name, *load);
    if (count == 64) report.condition(name + ": at most 0.2 of a core", load->cores <= kMaxOfACore);
  }
  return {};
}

Result<void> persons(Report& report, double run_seconds) {
  for (const int count : {1, 2, 4, 8}) {
    const auto load = load_of(6, count, run_seconds);
    if (!load) return pass(load);
    report_load(report, fmt::format("persons-{}", count), *load);
  }
  return {};
}

/// Event streams of one person's frames; the readers share the cores with the server.
Result<void> readers(Report& report, double run_seconds) {
  const auto cell = start_cell(3, 1);
  if (!cell) return pass(cell);
  std::this_thread::sleep_for(kWarmUp);
  report.row("readers-0", "fusion_cores", cores_used(*cell, run_seconds), "cores");
  for (const int count : {100, 300, 1000})
    report_reading(report, fmt::format("readers-{}", count),
                   read_by(*cell, {.event_streams = count}, run_seconds));
  return {};
}

/// Many more readers than two cores can serve at 30 Hz: nobody may be cut off, and the tracker's
/// own frames may not be late.
Result<void> behind_nginx(Report& report, double run_seconds) {
  constexpr int kMany = 3000;
  if (!std::filesystem::exists(kNginx))
    return report.note("LEFT OUT: nginx-3000: nginx is not installed"), Result<void>{};
  const auto cell =
      start_cell(3, 1, {"http.max_connections=4000", R"(http.trusted_proxies=["127.0.0.1"])"});
  if (!cell) return pass(cell);
  const std::uint16_t port = testing::free_port();
  const auto nginx = start_proxy({.folder = cell->folder.path(),
                                  .port = port,
                                  .upstream = cell->port,
                                  .connections = 2 * kMany + 200,
                                  .lines = "proxy_http_version 1.1; proxy_buffering off;"});
  if (!nginx) return pass(nginx);
  std::this_thread::sleep_for(kWarmUp);
  const ClientCrowd crowd(*cell, {.event_streams = kMany, .http_port = port});
  std::this_thread::sleep_for(3 * kWarmUp);
  const auto begun = Steady::now();
  const ClientAnswers before = crowd.answers();
  const double proxy = nginx->cpu_seconds();
  const double server = cell->fusion.front().cpu_seconds();
  const auto seen = watch(*cell, run_seconds);
  if (!seen) return pass(seen);
  const ClientAnswers after = crowd.answers();
  const double elapsed = std::chrono::duration<double>(Steady::now() - begun).count();
  const std::string name = "nginx-3000";
  report.row(name, "fusion_cores", (cell->fusion.front().cpu_seconds() - server) / elapsed,
             "cores");
  report.row(name, "nginx_cores", (nginx->cpu_seconds() - proxy) / elapsed, "cores");
  report.row(name, "client_hz", static_cast<double>(after.events - before.events) / elapsed / kMany,
             "Hz");
  report.row(name, "slowest_client_hz", static_cast<double>(fewest(before, after)) / elapsed, "Hz");
  report.row(name, "connections_lost", static_cast<double>(after.lost), "connections");
  report.row(name, "output_hz", seen->output_hz, "Hz", "configured", seen->output_hz / kRate);
  report.row(name, "lost_frames", static_cast<double>(seen->lost), "frames");
  report.row(name, "rss_mb", cell->fusion.front().resident_mb(), "MB");
  report.condition(name + ": nobody is cut off", after.lost == 0);
  report.condition(name + ": everybody goes on receiving", fewest(before, after) > 0);
  report.condition(name + ": the tracker itself loses nothing", seen->lost == 0);
  return {};
}

struct ScaleCase {
  const char* name;
  Result<void> (*run)(Report& report, double run_seconds);
};
constexpr ScaleCase kScaleCases[] = {{"sensors", sensors},
                                     {"persons", persons},
                                     {"readers", readers},
                                     {"readers-300", readers_300},
                                     {"nginx-3000", behind_nginx}};

}  // namespace

Result<void> run_scale(Report& report) {
  if (report.list()) {
    for (const ScaleCase& each : kScaleCases) std::cout << each.name << '\n';
    return {};
  }
  const double run_seconds = report.quick() ? 3.0 : 20.0;
  bool any = false;
  for (const ScaleCase& each : kScaleCases) {
    if (!report.only().empty() && report.only() != each.name) continue;
    any = true;
    if (auto done = each.run(report, run_seconds); !done) return done;
  }
  if (!any) {
    return fail(ErrorCode::InvalidArgument, "--only",
                "there is no case \"" + report.only() + "\"; --list shows all");
  }
  report.note(
      "fusion_cores: user and system time of chorus-fusion.  readers_cores: what it uses more than "
      "without readers.  sensors-N: one person; persons-N: six sensors; readers-N and nginx-N: "
      "event "
      "streams of one person before three sensors; events-300 and websockets-300: of six people.  "
      "Sensors and readers run in this process, on the same cores as the server.");
  return {};
}

}  // namespace chorus::bench
