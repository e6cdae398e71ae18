// A flood of requests causes few connections; a client that repeats its request gets one.
#include "fusion-server/vrpn/request_gate.h"

#include <gtest/gtest.h>

namespace chorus::vrpn {
namespace {

using std::chrono::milliseconds;
using Verdict = RequestGate::Verdict;

const SteadyTime kNow = SteadyTime() + std::chrono::hours(1);

Asker asker(int address, int port = 5000) {
  return {"10.0." + std::to_string(address / 250) + "." + std::to_string(address % 250),
          static_cast<std::uint16_t>(port)};
}

TEST(RequestGate, AsksForOneConnectionPerClient) {
  RequestGate gate;
  EXPECT_EQ(gate.ask(asker(1, 5000), kNow), Verdict::Connect);
  EXPECT_EQ(gate.ask(asker(1, 5000), kNow), Verdict::Repeated);
  EXPECT_EQ(gate.ask(asker(1, 5001), kNow), Verdict::Connect);
  gate.connected(asker(1, 5000));
  EXPECT_EQ(gate.ask(asker(1, 5000), kNow), Verdict::Repeated);
  gate.gone(asker(1, 5000));
  EXPECT_EQ(gate.ask(asker(1, 5000), kNow), Verdict::Connect);
}

TEST(RequestGate, MakesFewConnectionsAtATime) {
  RequestGate gate({.most_under_way = 3, .all = {1000, 1000}});
  int made = 0;
  for (int i = 0; i < 10'000; ++i) made += gate.ask(asker(i), kNow) == Verdict::Connect;
  EXPECT_EQ(made, 3);
  gate.connected(asker(0));
  EXPECT_EQ(gate.ask(asker(20'000), kNow), Verdict::Connect);
  gate.failed(asker(1));
  EXPECT_EQ(gate.ask(asker(20'001), kNow), Verdict::Connect);
  EXPECT_EQ(gate.ask(asker(20'002), kNow), Verdict::Refused);
}

TEST(RequestGate, MakesFewConnectionsASecond) {
  RequestGate gate({.most_under_way = 1000, .all = {10, 5}});
  auto made = [&gate, n = 0](SteadyTime now) mutable {
    int count = 0;
    for (int i = 0; i < 100; ++i) count += gate.ask(asker(++n), now) == Verdict::Connect;
    return count;
  };
  EXPECT_EQ(made(kNow), 5);
  EXPECT_EQ(made(kNow + milliseconds(50)), 0);
  EXPECT_EQ(made(kNow + milliseconds(250)), 2);
  EXPECT_EQ(made(kNow + std::chrono::hours(9)), 5);
}

/// Counts over a minute in which one address asks 500 times a second, each time for another port,
/// and every two seconds another host asks once: how often the flood was connected, and how many
/// of the other hosts were refused.
struct Flood {
  int flooded = 0;
  int refused = 0;
};

Flood flood(RequestGate& gate, void (RequestGate::*end)(const Asker&)) {
  Flood counted;
  for (int ms = 0; ms < 60'000; ms += 2) {
    const SteadyTime now = kNow + milliseconds(ms);
    const Asker flooder = asker(1, 1024 + ms / 2);
    if (gate.ask(flooder, now) == Verdict::Connect) {
      ++counted.flooded;
      (gate.*end)(flooder);
    }
    if (ms % 2000 != 1000) continue;
    const Asker other = asker(2 + ms / 2000);
    const bool served = gate.ask(other, now) == Verdict::Connect;
    counted.refused += served ? 0 : 1;
    if (served) gate.connected(other);
  }
  return counted;
}

TEST(RequestGate, AFloodFromOneAddressLeavesTheOthersTheirs) {
  RequestGate answered;
  const Flood connects = flood(answered, &RequestGate::connected);
  EXPECT_EQ(connects.refused, 0);
  EXPECT_LE(connects.flooded, 32 + 60 * 16);
  RequestGate closed;
  const Flood fails = flood(closed, &RequestGate::failed);
  EXPECT_EQ(fails.refused, 0);
  EXPECT_LE(fails.flooded, 32 + 60 * 16 / 5) << "where nobody answers costs five times as much";
}

TEST(RequestGate, ConnectionsThatNeverEndDoNotTakeTheOthersPlaces) {
  RequestGate gate;
  int made = 0;
  for (int i = 0; i < 1000; ++i) made += gate.ask(asker(1, 1024 + i), kNow) == Verdict::Connect;
  EXPECT_EQ(made, 8);
  EXPECT_EQ(gate.ask(asker(2), kNow), Verdict::Connect);
}

TEST(RequestGate, RemembersAFewAddressesAndForgetsThemWhenTheyAreQuiet) {
  RequestGate gate({.all = {1e6, 1e6}, .source = {1, 2}, .most_sources = 3});
  const auto ask = [&gate](int address, int port, SteadyTime now) {
    const auto verdict = gate.ask(asker(address, port), now);
    gate.connected(asker(address, port));
    return verdict;
  };
  for (int i = 1; i <= 3; ++i) EXPECT_EQ(ask(i, 1, kNow), Verdict::Connect);
  // All addresses beyond the limit share one allowance.
  EXPECT_EQ(ask(4, 1, kNow), Verdict::Connect);
  EXPECT_EQ(ask(5, 1, kNow), Verdict::Connect);
  EXPECT_EQ(ask(6, 1, kNow), Verdict::Refused);
  EXPECT_EQ(ask(1, 2, kNow), Verdict::Connect) << "one that is known keeps its own";
  const SteadyTime later = kNow + std::chrono::seconds(5);
  for (int i = 7; i <= 9; ++i) {
    EXPECT_EQ(ask(i, 1, later), Verdict::Connect);
    EXPECT_EQ(ask(i, 2, later), Verdict::Connect);
    EXPECT_EQ(ask(i, 3, later), Verdict::Refused);
  }
}

}  // namespace
}  // namespace chorus::vrpn
