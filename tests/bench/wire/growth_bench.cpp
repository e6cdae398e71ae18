// chorus-bench growth: measures what many clients and many sensors cost the fusion server.
#include <chrono>
#include <iostream>
#include <string>
#include <thread>

#include "tests/bench/live/live_cell.h"
#include "tests/bench/report/report.h"

namespace chorus::bench {
namespace {

using Steady = std::chrono::steady_clock;

constexpr double kRate = 30.0;       // [Hz]
constexpr double kMinShare = 0.99;   // fraction of frames that readers get on average
constexpr double kMaxRatio = 1.3;    // the claim: cost of a WebSocket over that of an event stream
constexpr double kMaxOfACore = 0.2;  // the claim: 64 sensors, one person
constexpr int kReaders = 300;
constexpr auto kWarmUp = std::chrono::seconds(2);

/// Processor time of the server during `run_seconds`, as a fraction of one core.
double cores_used(const LiveCell& cell, double run_seconds) {
  const auto begun = Steady::now();
  const double before = cell.fusion.front().cpu_seconds();
  std::this_thread::sleep_for(std::chrono::duration<double>(run_seconds));
  const double used = cell.fusion.front().cpu_seconds() - before;
  return used / std::chrono::duration<double>(Steady::now() - begun).count();
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
  out.hz = static_cast<double>(got) / elapsed / kReaders;
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
  report.row("readers-0", "fusion_cores", alone, "cores");
  report_reading(report, "events-300", events);
  report_reading(report, "websockets-300", sockets);
  report.row("websockets-300", "readers_cores", sockets.cores - alone, "cores", "events-300",
             ratio);
  report.condition("websockets-300: at most 1.3 x the same event streams", ratio <= kMaxRatio);
  return {};
}

Result<void> sensors_64(Report& report, double run_seconds) {
  const auto cell = start_cell(64, 1);
  if (!cell) return pass(cell);
  std::this_thread::sleep_for(kWarmUp);
  const double cores = cores_used(*cell, run_seconds);
  const auto seen = watch(*cell, run_seconds / 2);
  if (!seen) return pass(seen);
  report.row("sensors-64", "fusion_cores", cores, "cores");
  report.row("sensors-64", "output_hz", seen->output_hz, "Hz", "configured",
             seen->output_hz / kRate);
  report.row("sensors-64", "lost_frames", static_cast<double>(seen->lost), "frames");
  report.condition("sensors-64: at most 0.2 of a core", cores <= kMaxOfACore);
  report.condition("sensors-64: nothing lost", seen->lost == 0);
  return {};
}

struct GrowthCase {
  const char* name;
  Result<void> (*run)(Report& report, double run_seconds);
};
constexpr GrowthCase kGrowthCases[] = {{"readers-300", readers_300}, {"sensors-64", sensors_64}};

}  // namespace

Result<void> run_growth(Report& report) {
  if (report.list()) {
    for (const GrowthCase& each : kGrowthCases) std::cout << each.name << '\n';
    return {};
  }
  const double run_seconds = report.quick() ? 3.0 : 20.0;
  bool any = false;
  for (const GrowthCase& each : kGrowthCases) {
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
      "without readers.  Six people before three sensors; 64 sensors before one person.  Sensors "
      "and readers run in this process, on the same cores as the server.");
  return {};
}

}  // namespace chorus::bench
