// chorus-bench publish: measures how long a fused frame takes to a client of each output, how long
// it takes from capture to a VRPN client of the real server, and whether 400 clients delay
// anybody.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "common/time/clock.h"
#include "tests/bench/live/live_cell.h"
#include "tests/bench/report/report.h"
#include "tests/bench/wire/output_receivers.h"
#include "tests/judge/statistics.h"
#include "tests/support/builders.h"

namespace chorus::bench {
namespace {

using std::chrono::milliseconds;
using Steady = std::chrono::steady_clock;

constexpr double kRate = 30.0;  // [Hz]
constexpr double kMs = 1e3;
constexpr double kMaxWireMs = 2.0;        // the claim, fused instant to client, p99
constexpr double kMaxCaptureMs = 10.0;    // the claim, last capture to VRPN client, p99
constexpr double kLateMs = 10.0;          // the claim: no frame takes longer
constexpr std::size_t kWarmUp = 30;       // frames
constexpr double kFullDatagram = 1400.0;  // [B]

std::shared_ptr<const Snapshot> six_people(std::uint64_t sequence) {
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->sequence = sequence;
  snapshot->instant = SystemClock().now();
  for (int i = 0; i < 6; ++i) {
    FusedBody body;
    body.id = {static_cast<std::uint64_t>(i + 1)};
    body.slot = static_cast<std::size_t>(i);
    body.skeleton =
        testing::standing_person({0.9 * i, 0, 0.01 * static_cast<double>(sequence % 100)}, 0.1 * i);
    snapshot->bodies.push_back(std::move(body));
  }
  return snapshot;
}

/// Waits for units on its own thread and records when they arrive.
class Watch {
 public:
  struct Arrival {
    Steady::time_point when;
    std::size_t units;  ///< Number of units received until then.
  };

  explicit Watch(Receiver& receiver) : receiver_(receiver) {
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
  }
  /// Ends reading and returns all arrivals.
  std::vector<Arrival> end() {
    thread_.request_stop();
    thread_.join();
    return std::move(arrivals_);
  }

 private:
  void run(const std::stop_token& stop) {
    std::vector<pollfd> sockets;
    receiver_.add_sockets(sockets);
    std::size_t units = 0;
    while (!stop.stop_requested()) {
      ::poll(sockets.data(), sockets.size(), 50);
      const std::size_t more = receiver_.read();
      if (more > 0) arrivals_.push_back({Steady::now(), units += more});
    }
  }
  Receiver& receiver_;
  std::vector<Arrival> arrivals_;
  std::jthread thread_;
};

struct Wire {
  std::vector<double> latencies;  ///< From publication to complete receipt [s].
  std::size_t units_per_frame = 0;
  double bytes_per_frame = 0.0;
  double output_hz = 0.0;  ///< Rate of receipt.
};

/// Publishes `frames` snapshots at 30 Hz, numbered from `first`; returns when each was published.
std::vector<Steady::time_point> publish(Sink& sink, std::size_t frames, std::uint64_t first) {
  std::vector<Steady::time_point> times;
  auto next = Steady::now();
  for (std::size_t i = 0; i < frames; ++i) {
    next += std::chrono::nanoseconds(from_seconds(1.0 / kRate));
    const auto snapshot = six_people(first + i);
    std::this_thread::sleep_until(next);
    times.push_back(Steady::now());
    sink.publish(snapshot);
  }
  std::this_thread::sleep_for(milliseconds(300));  // until the last one has arrived
  return times;
}

Result<Wire> measure(OpenedOutput& output, std::size_t frames) {
  {
    Watch warming(*output.receiver);
    publish(*output.sink, kWarmUp, 1);
  }
  const std::size_t bytes = output.receiver->bytes();
  Watch watch(*output.receiver);
  const auto published = publish(*output.sink, frames, kWarmUp + 1);
  const auto arrivals = watch.end();
  const std::size_t units = arrivals.empty() ? 0 : arrivals.back().units;
  if (units == 0 || units % frames != 0) {
    return fail(ErrorCode::Internal, std::string(output.sink->name()),
                "frames were lost: " + std::to_string(units) + " units for " +
                    std::to_string(frames) + " frames");
  }
  Wire wire;
  wire.units_per_frame = units / frames;
  wire.bytes_per_frame =
      static_cast<double>(output.receiver->bytes() - bytes) / static_cast<double>(frames);
  wire.output_hz =
      static_cast<double>(frames - 1) /
      std::chrono::duration<double>(arrivals.back().when - arrivals.front().when).count();
  auto arrival = arrivals.begin();
  for (std::size_t i = 0; i < frames; ++i) {
    while (arrival->units < (i + 1) * wire.units_per_frame) ++arrival;
    wire.latencies.push_back(std::chrono::duration<double>(arrival->when - published[i]).count());
  }
  return wire;
}

/// Sends the same number of bytes through the same hand-over, in as many datagrams as the output
/// sends; for VRPN, which packs many messages together, in full datagrams.
Result<Wire> measure_bare(std::string_view name, const Wire& wire, std::size_t frames) {
  const bool packed = name.starts_with("vrpn");
  const auto count = packed
                         ? static_cast<std::size_t>(std::ceil(wire.bytes_per_frame / kFullDatagram))
                         : wire.units_per_frame;
  OpenedOutput bare = bare_datagrams(count, static_cast<std::size_t>(wire.bytes_per_frame) / count);
  return measure(bare, frames);
}

double late_of(const std::vector<double>& latencies) {
  return static_cast<double>(std::count_if(latencies.begin(), latencies.end(),
                                           [](double latency) { return kMs * latency > kLateMs; }));
}

/// The worst figures among all outputs, and the late frames of all.
struct Worst {
  double p99 = 0.0;
  double output_hz = kRate;
  double late = 0.0;

  void take(const Wire& wire) {
    p99 = std::max(p99, percentile(wire.latencies, 0.99));
    output_hz = std::min(output_hz, wire.output_hz);
    late += late_of(wire.latencies);
  }
};

Result<void> sinks_6_persons(Report& report) {
  const std::size_t frames = report.quick() ? 60 : 600;
  Worst worst_of_all;
  for (const OutputRow& row : output_rows()) {
    auto output = row.open();
    if (!output) return pass(output);
    const auto wire = measure(*output, frames);
    if (!wire) return pass(wire);
    const auto bare = measure_bare(row.name, *wire, frames);
    if (!bare) return pass(bare);
    worst_of_all.take(*wire);
    const std::string name = "sinks-6-persons-" + std::string(row.name);
    for (const auto& [metric, share] : {std::pair{"p50", 0.5}, std::pair{"p99", 0.99}}) {
      const double ours = percentile(wire->latencies, share);
      report.row(name, std::string("fused_to_wire_") + metric + "_ms", kMs * ours, "ms",
                 "bare-datagrams", ours / percentile(bare->latencies, share));
    }
    report.row(name, "bytes_per_frame", wire->bytes_per_frame, "B");
    report.condition(name + ": fused to client p99 is below 2 ms",
                     kMs * percentile(wire->latencies, 0.99) < kMaxWireMs);
  }
  const std::string all = "sinks-6-persons";
  report.row(all, "fused_to_wire_p99_ms", kMs * worst_of_all.p99, "ms");
  report.row(all, "output_hz", worst_of_all.output_hz, "Hz", "configured",
             worst_of_all.output_hz / kRate);
  report.row(all, "late_frames", worst_of_all.late, "frames");
  return {};
}

void report_lateness(Report& report, const std::string& name, const Lateness& seen,
                     const Lateness* alone) {
  const auto ratio = [&](double share) {
    return alone == nullptr
               ? kNoRatio
               : percentile(seen.beyond_capture, share) / percentile(alone->beyond_capture, share);
  };
  const std::string baseline = alone == nullptr ? "" : "one-client";
  report.row(name, "output_hz", seen.output_hz, "Hz", "configured", seen.output_hz / kRate);
  report.row(name, "lost_frames", static_cast<double>(seen.lost), "frames");
  report.row(name, "capture_to_vrpn_p50_ms", kMs * percentile(seen.beyond_capture, 0.5), "ms",
             baseline, ratio(0.5));
  report.row(name, "capture_to_vrpn_p99_ms", kMs * percentile(seen.beyond_capture, 0.99), "ms",
             baseline, ratio(0.99));
  report.row(name, "capture_to_vrpn_max_ms", kMs * worst(seen.beyond_capture), "ms");
  report.row(name, "late_frames", late_of(seen.beyond_capture), "frames");
  // Fusing starts after the capture, so this is an upper bound.
  report.row(name, "fused_to_wire_p99_ms", kMs * percentile(seen.beyond_capture, 0.99), "ms");
  report.condition(name + ": output at 30 Hz, nothing lost",
                   std::abs(seen.output_hz - kRate) < 0.3 && seen.lost == 0);
}

struct ClientRates {
  double vrpn = 0.0;
  double long_poll = 0.0;
  double events = 0.0;
};

ClientRates rates(const ClientAnswers& before, const ClientAnswers& after,
                  const ClientCounts& clients, double elapsed) {
  const auto rate = [&](std::uint64_t count, int of) {
    return static_cast<double>(count) / elapsed / of;
  };
  return {rate(after.vrpn_frames - before.vrpn_frames, clients.vrpn),
          rate(after.long_polls - before.long_polls, clients.long_polls),
          rate(after.events - before.events, clients.event_streams)};
}

Result<void> clients_400(Report& report, const LiveCell& cell, const Lateness& alone,
                         double run_seconds) {
  constexpr ClientCounts kClients{49, 300, 50};  // with the client of watch(), 400 in all
  const std::string name = "clients-400";
  const ClientCrowd crowd(cell, kClients);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  const ClientAnswers before = crowd.answers();
  const auto begun = Steady::now();
  const auto seen = watch(cell, run_seconds);
  if (!seen) return pass(seen);
  const double elapsed = std::chrono::duration<double>(Steady::now() - begun).count();
  const ClientAnswers after = crowd.answers();
  const ClientRates rate = rates(before, after, kClients, elapsed);
  report_lateness(report, name, *seen, &alone);
  report.row(name, "vrpn_client_hz", rate.vrpn, "Hz");
  report.row(name, "long_poll_client_hz", rate.long_poll, "Hz");
  report.row(name, "event_stream_client_hz", rate.events, "Hz");
  // At either end of the run a client may be one frame behind the others.
  const double slowest = static_cast<double>(fewest(before, after) + 1) / elapsed;
  report.row(name, "slowest_client_hz", slowest, "Hz");
  report.row(name, "connections_lost", static_cast<double>(after.lost), "connections");
  report.condition(name + ": no frame later than 10 ms after its last capture",
                   kMs * worst(seen->beyond_capture) <= kLateMs);
  report.condition(name + ": every client gets every frame",
                   slowest > 0.99 * kRate && after.lost == 0);
  return {};
}

Result<void> through_the_server(Report& report) {
  const auto cell = start_cell(6, 1);
  if (!cell) return pass(cell);
  const double run_seconds = report.quick() ? 4.0 : 30.0;
  const auto alone = watch(*cell, run_seconds);
  if (!alone) return pass(alone);
  report_lateness(report, "one-client", *alone, nullptr);
  report.condition("one-client: last capture to VRPN p99 is below 10 ms",
                   kMs * percentile(alone->beyond_capture, 0.99) < kMaxCaptureMs);
  return clients_400(report, *cell, *alone, run_seconds);
}

}  // namespace

Result<void> run_publish(Report& report) {
  if (auto done = sinks_6_persons(report); !done) return done;
  if (auto done = through_the_server(report); !done) return done;
  report.note(
      "fused_to_wire: from handing a snapshot of six persons to the output to the receipt of its "
      "last byte by a client on loopback; bare-datagrams is the same number of bytes from the same "
      "kind of thread behind the same hand-over, with nothing encoded.");
  report.note(
      "capture_to_vrpn: from the last capture that an instant had to wait for to its receipt by a "
      "VRPN client (UDP), through real HTTP polling, alignment and fusion of six sensors and one "
      "person; the alignment delay is thereby left out.");
  report.note(
      "sinks-6-persons is the worst of its outputs.  one-client and clients-400 give "
      "capture_to_vrpn as fused_to_wire too: an upper bound, for the server's own moment of fusing "
      "is not known here.");
  report.note(
      "The 399 other clients, six sensors and the witness run in this process, on the same "
      "cores as the server.");
  return {};
}

}  // namespace chorus::bench
