// One host occupies every client slot of the tracking protocols.
#include <memory>

#include <fmt/format.h>

#include "tests/bench/faults/sockets.h"
#include "tests/bench/faults/trial.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::bench {
namespace {

constexpr double kFirstDataPatience = 3.0;  // until a client's first data [s]

/// A cell with one output that any host may use, and another host that uses it.
struct Crowded {
  std::string host;
  std::uint16_t port = 0;
  std::unique_ptr<Cell> cell;
};

Result<Crowded> crowded(Trial& trial, Settings settings, std::string_view port_key) {
  const auto host = foreign_address();
  if (!host) {
    trial.leave_out("this host has no address beside loopback");
    return fail(ErrorCode::Unavailable, "address", trial.left_out);
  }
  Crowded out{*host, testing::free_port(), nullptr};
  CellPlan plan{.sensors = 2};
  plan.fusion = std::move(settings);
  plan.fusion.push_back(fmt::format("{}={}", port_key, out.port));
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  out.cell = std::make_unique<Cell>(std::move(*cell));
  return out;
}

void check_rest(Trial& trial, Cell& cell) {
  const Watch watch(cell.port());
  wait_for(0.5);
  const Timestamp begun = now();
  wait_for(2.0);
  trial.check_others(cell, account_of(watch.seen(), begun, now()), cell.placed());
}

Result<void> vrpn_seats(Trial& trial) {
  constexpr int kMany = 80;
  auto rig = crowded(trial,
                     {"outputs.vrpn.enabled=true", "outputs.vrpn.address=0.0.0.0",
                      "outputs.vrpn.allow=[\"0.0.0.0/0\"]"},
                     "outputs.vrpn.port");
  if (!rig) return pass(rig);
  std::vector<RawSocket> idle;
  for (int i = 0; i < kMany; ++i) idle.push_back(connect_to({rig->host, rig->port}));
  wait_for(0.5);
  testing::VrpnClient client({"Body0"});
  const bool served =
      client.connect(rig->port) &&
      client.next("vrpn_Tracker Pos_Quat", std::chrono::milliseconds(3000)).has_value();
  trial.check(served, "another host gets poses");
  check_rest(trial, *rig->cell);
  return {};
}

Result<void> dtrack_seats(Trial& trial) {
  constexpr int kMany = 8;
  auto rig = crowded(
      trial,
      {"outputs.dtrack.enabled=true", "outputs.dtrack.command.enabled=true",
       "outputs.dtrack.command.address=0.0.0.0", "outputs.dtrack.command.allow=[\"0.0.0.0/0\"]"},
      "outputs.dtrack.command.port");
  if (!rig) return pass(rig);
  std::vector<RawSocket> idle;
  for (int i = 0; i < kMany; ++i) idle.push_back(connect_to({rig->host, rig->port}));
  wait_for(0.5);
  const auto client = connect_to({.port = rig->port});
  (void)client.say(std::string_view("dtrack2 get status active\0", 26));
  trial.check(client.hear(kFirstDataPatience).starts_with("dtrack2 set status"),
              "another host is answered");
  check_rest(trial, *rig->cell);
  return {};
}

constexpr std::string_view kConnect("\0\0\0\0", 4);     // message 0, no payload
constexpr std::string_view kModels("\4\0\0\0", 4);      // message 4
constexpr std::string_view kKeepAlive("\12\0\0\0", 4);  // message 10
constexpr char kFrameMessage = 7;

/// True if frames come.  Acts like the vendor's clients: connects, asks for models, keeps alive.
bool natnet_serves(const End& end) {
  const auto client = datagrams_to(end);
  (void)client.say(kConnect);
  (void)client.hear(1.0);
  (void)client.say(kModels);
  const Timestamp begun = now();
  while (seconds(now() - begun) < kFirstDataPatience) {
    (void)client.say(kKeepAlive);
    for (int i = 0; i < 20; ++i) {
      const std::string datagram = client.hear(0.1);
      if (!datagram.empty() && datagram.front() == kFrameMessage) return true;
    }
  }
  return false;
}

Settings natnet_settings() {
  return {"outputs.natnet.enabled=true", "outputs.natnet.address=0.0.0.0",
          "outputs.natnet.allow=[\"0.0.0.0/0\"]",
          fmt::format("outputs.natnet.data_port={}", testing::free_port())};
}

Result<void> natnet_seats(Trial& trial) {
  constexpr int kMany = 32;
  auto rig = crowded(trial, natnet_settings(), "outputs.natnet.command_port");
  if (!rig) return pass(rig);
  std::vector<RawSocket> all;
  for (int i = 0; i < kMany; ++i) {
    all.push_back(datagrams_to({rig->host, rig->port}));
    (void)all.back().say(kConnect);
    (void)all.back().say(kKeepAlive);
  }
  wait_for(0.5);
  trial.check(natnet_serves({.port = rig->port}), "another host gets frames");
  check_rest(trial, *rig->cell);
  return {};
}

/// A datagram's sender can be forged: a single one must not start a flood.
Result<void> natnet_one_datagram(Trial& trial) {
  constexpr std::size_t kMax = 2048;
  auto rig = crowded(trial, natnet_settings(), "outputs.natnet.command_port");
  if (!rig) return pass(rig);
  const auto victim = datagrams_to({rig->host, rig->port});
  (void)victim.say(kConnect);
  std::size_t bytes = 0;
  const Timestamp begun = now();
  while (seconds(now() - begun) < kFirstDataPatience) bytes += victim.hear(0.1).size();
  trial.check(bytes > 0 && bytes <= kMax,
              fmt::format("4 bytes asked, {} answered within 3 s", bytes));
  trial.check(natnet_serves({.port = rig->port}), "a client that goes on asking gets frames");
  check_rest(trial, *rig->cell);
  return {};
}

}  // namespace

FaultCases output_cases() {
  return {
      {"vrpn-seats", "one host holds 80 idle VRPN connections", vrpn_seats},
      {"dtrack-seats", "one host holds 8 idle DTrack connections", dtrack_seats},
      {"natnet-seats", "one host connects 32 NatNet clients", natnet_seats},
      {"natnet-datagram", "one NatNet datagram, and nothing more", natnet_one_datagram},
  };
}

}  // namespace chorus::bench
