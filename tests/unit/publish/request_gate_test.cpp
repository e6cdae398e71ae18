// A flood of requests makes few connections; a client that repeats itself gets one.
#include "fusion-server/publish/vrpn/request_gate.h"

#include <gtest/gtest.h>

namespace chorus::publish::vrpn {
namespace {

using std::chrono::milliseconds;
using Verdict = RequestGate::Verdict;

const SteadyTime kNow = SteadyTime() + std::chrono::hours(1);

TEST(RequestGate, AsksForOneConnectionPerClient) {
  RequestGate gate;
  EXPECT_EQ(gate.ask("10.0.0.1:5000", kNow), Verdict::Connect);
  EXPECT_EQ(gate.ask("10.0.0.1:5000", kNow), Verdict::Repeated);
  EXPECT_EQ(gate.ask("10.0.0.1:5001", kNow), Verdict::Connect);
  gate.connected("10.0.0.1:5000");
  EXPECT_EQ(gate.ask("10.0.0.1:5000", kNow), Verdict::Repeated);
  gate.gone("10.0.0.1:5000");
  EXPECT_EQ(gate.ask("10.0.0.1:5000", kNow), Verdict::Connect);
}

TEST(RequestGate, MakesFewConnectionsAtATime) {
  RequestGate gate({.most_under_way = 3, .per_second = 1000, .burst = 1000});
  int made = 0;
  for (int i = 0; i < 10'000; ++i) made += gate.ask(std::to_string(i), kNow) == Verdict::Connect;
  EXPECT_EQ(made, 3);
  gate.connected("0");
  EXPECT_EQ(gate.ask("a", kNow), Verdict::Connect);
  gate.gone("1");
  EXPECT_EQ(gate.ask("b", kNow), Verdict::Connect);
  EXPECT_EQ(gate.ask("c", kNow), Verdict::Refused);
}

TEST(RequestGate, MakesFewConnectionsASecond) {
  RequestGate gate({.most_under_way = 1000, .per_second = 10, .burst = 5});
  auto made = [&gate, n = 0](SteadyTime now) mutable {
    int count = 0;
    for (int i = 0; i < 100; ++i) count += gate.ask(std::to_string(++n), now) == Verdict::Connect;
    return count;
  };
  EXPECT_EQ(made(kNow), 5);
  EXPECT_EQ(made(kNow + milliseconds(50)), 0);
  EXPECT_EQ(made(kNow + milliseconds(250)), 2);
  EXPECT_EQ(made(kNow + std::chrono::hours(9)), 5);
}

}  // namespace
}  // namespace chorus::publish::vrpn
