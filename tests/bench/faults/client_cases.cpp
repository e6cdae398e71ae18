// Clients that take all resources they can get.
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tests/bench/faults/sockets.h"
#include "tests/bench/faults/trial.h"

namespace chorus::bench {
namespace {

constexpr std::string_view kUpgrade =
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
constexpr std::string_view kEvents =
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n";
constexpr std::string_view kGet =
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: application/ld+json\r\n\r\n";

/// A cell whose server listens on every address, so that a client of another host can connect.
CellPlan open_cell() {
  CellPlan plan;
  plan.address = "0.0.0.0";
  plan.fusion = {"http.bearer_token=0123456789abcdef0123456789abcdef"};
  return plan;
}

/// Summary of what a well-behaved client sees during the next `duration` [s].
Account watched(const Watch& watch, double duration) {
  const Timestamp begun = now();
  wait_for(duration);
  return account_of(watch.seen(), begun, now());
}

Result<void> idle_connections(Trial& trial) {
  constexpr int kMany = 1200;
  const auto host = foreign_address();
  if (!host) return trial.leave_out("this host has no address beside loopback"), Result<void>{};
  CellPlan plan = open_cell();
  plan.surroundings.descriptors = 1024;  // the default of services
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const Timestamp begun = now();
  std::vector<RawSocket> idle;
  for (int i = 0; i < kMany; ++i) idle.push_back(connect_to({*host, cell->port()}));
  wait_for(1.0);
  trial.check(cell->ask({"GET", "/healthz"}).status == 200, "another host's /healthz is answered");
  cell->sensor(1).kill();
  wait_for(1.0);
  if (auto started = cell->start_sensor(1); !started) return started;
  const Timestamp back = now();
  const auto took = [&] { return recovery(watch.seen(), back, cell->placed()); };
  (void)wait_until(5.0, [&] { return std::isfinite(took()); });
  trial.check_recovery(took(), 1.5);
  trial.check_others(*cell, account_of(watch.seen(), begun, now()), {"s1", "s3"});
  return {};
}

Result<void> slowloris(Trial& trial) {
  constexpr int kMany = 200;
  auto cell = Cell::start({});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  std::vector<RawSocket> slow;
  for (int i = 0; i < kMany; ++i) slow.push_back(connect_to({.port = cell->port()}));
  const std::jthread drip([&](const std::stop_token& stop) {
    for (std::size_t at = 0; !stop.stop_requested() && at + 4 < kGet.size(); ++at) {
      for (const RawSocket& each : slow) (void)each.say(kGet.substr(at, 1));
      wait_for(0.2);
    }
  });
  const Account account = watched(watch, 7.0);
  const auto gone = std::ranges::count_if(slow, [](const RawSocket& s) { return s.hung_up(); });
  trial.check(gone == kMany, fmt::format("all are hung up on: {} of {}", gone, kMany));
  trial.check_others(*cell, account, cell->placed());
  return {};
}

/// Forty clients send `request` `times` times each and never read; nothing may accumulate for them.
Result<void> never_reading(Trial& trial, std::string_view request, int times) {
  constexpr int kMany = 40;
  constexpr double kMaxMore = 25.0;  // [MB]
  auto cell = Cell::start({});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const double before = cell->fusion().resident_mb();
  std::vector<RawSocket> silent;
  for (int i = 0; i < kMany; ++i) silent.push_back(connect_to({.port = cell->port()}, true));
  for (int i = 0; i < times; ++i) {
    for (const RawSocket& each : silent) (void)each.say(request);
  }
  const Account account = watched(watch, 6.0);
  trial.check_others(*cell, account, cell->placed());
  trial.check(trial.rss_mb - before < kMaxMore,
              fmt::format("less than {} MB more: {:.1f}", kMaxMore, trial.rss_mb - before));
  return {};
}

Result<void> never_reading_polls(Trial& trial) { return never_reading(trial, kGet, 300); }
Result<void> never_reading_events(Trial& trial) { return never_reading(trial, kEvents, 1); }
Result<void> never_reading_sockets(Trial& trial) { return never_reading(trial, kUpgrade, 1); }

/// For some seconds clients come and go as fast as they can and one sensor dies again and again;
/// `chorus-bench soak` does it for long.
Result<void> churn(Trial& trial) {
  auto cell = Cell::start({});
  if (!cell) return pass(cell);
  const Watch watch(cell->port());
  wait_for(1.0);
  const std::size_t before = cell->fusion().descriptors();
  std::atomic<int> served = 0;
  std::jthread clients([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      for (const std::string_view request : {kGet, kEvents, kUpgrade})
        served += head_of_answer({.port = cell->port()}, request).empty() ? 0 : 1;
    }
  });
  const Timestamp begun = now();
  for (int i = 0; i < 3; ++i) {
    cell->sensor(1).kill();
    wait_for(1.0);
    if (auto started = cell->start_sensor(1); !started) return started;
    wait_for(1.0);
  }
  const Account account = account_of(watch.seen(), begun, now());
  clients.request_stop();
  clients.join();
  const auto settled = [&] { return cell->fusion().descriptors() == before; };
  trial.check(wait_until(5.0, settled), fmt::format("descriptors: {} before, {} after", before,
                                                    cell->fusion().descriptors()));
  trial.check(served > 30, fmt::format("{} clients were served", served.load()));
  trial.check_others(*cell, account, {"s1", "s3"});
  return {};
}

}  // namespace

FaultCases client_cases() {
  return {
      {"idle-1200", "1200 idle connections of one host, 1024 descriptors, a sensor restarts",
       idle_connections},
      {"slowloris", "200 requests that come byte by byte", slowloris},
      {"unread-answers", "40 clients ask 300 times and never read", never_reading_polls},
      {"unread-events", "40 event streams that nobody reads", never_reading_events},
      {"unread-websockets", "40 WebSockets that nobody reads", never_reading_sockets},
      {"churn", "clients and one sensor come and go", churn},
  };
}

}  // namespace chorus::bench
