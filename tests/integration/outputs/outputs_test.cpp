// What really arrives on a socket when outputs are enabled in the configuration.
#include "fusion-server/outputs/outputs.h"

#include <thread>

#include <gtest/gtest.h>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/outputs/datagram_receiver.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/osc/osc_reader.h"

namespace chorus::outputs {
namespace {

using chorus::testing::IsOk;
using http::test::RawClient;
using outlet::testing::DatagramReceiver;
using namespace std::string_literals;

std::shared_ptr<const Snapshot> somebody(std::uint64_t sequence) {
  auto s = std::make_shared<Snapshot>();
  s->sequence = sequence;
  s->instant = chorus::testing::kStart;
  s->bodies.resize(1);
  s->bodies[0].slot = 0;
  s->bodies[0].skeleton = chorus::testing::standing_person({1, 0, 2});
  return s;
}

/// The only sink that is enabled.
std::unique_ptr<Sink> sink_of(
    const OutputsConfig& config,
    const std::shared_ptr<const Clock>& clock = std::make_shared<SystemClock>()) {
  auto sinks = open_outputs(config, {clock});
  EXPECT_THAT(sinks, IsOk());
  if (!sinks || sinks->size() != 1) return nullptr;
  return std::move(sinks->front());
}

OutputsConfig dtrack_to(const std::vector<std::string>& targets) {
  OutputsConfig config;
  config.dtrack.common.enabled = true;
  config.dtrack.protocol.targets = targets;
  config.dtrack.protocol.source_port = outlet::testing::free_port();
  return config;
}

TEST(DtrackOutput, SendsEachFrameFromItsPortToAllTargets) {
  DatagramReceiver first;
  DatagramReceiver second;
  const OutputsConfig config = dtrack_to({first.target(), second.target()});
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(somebody(41));
  for (DatagramReceiver* receiver : {&first, &second}) {
    const std::string datagram = receiver->next();
    EXPECT_TRUE(datagram.starts_with("fr 41\r\n")) << datagram;
    EXPECT_TRUE(datagram.ends_with("\r\n"));
    EXPECT_NE(datagram.find("\r\n6d 25 [0 1.000][1000.000 -2000.000 950.000 "), std::string::npos);
    EXPECT_EQ(receiver->sender_port(), config.dtrack.protocol.source_port);
  }
}

class LateClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const override {
    return chorus::testing::kStart + std::chrono::microseconds(4321);
  }
};

TEST(DtrackOutput, TellsItsLatencyByTheClockOfTheServer) {
  DatagramReceiver receiver;
  const auto sink = sink_of(dtrack_to({receiver.target()}), std::make_shared<LateClock>());
  ASSERT_TRUE(sink);
  sink->publish(somebody(1));
  EXPECT_NE(receiver.next().find(" 4321\r\n6dcal"), std::string::npos);
}

TEST(DtrackOutput, ReachesAMulticastGroup) {
  const char* group = "239.255.77.77";
  DatagramReceiver member(true);
  const bool joined = member.join(group);
  DatagramReceiver(true).say("probe", member.port(), group);
  if (!joined || member.next(500) != "probe") GTEST_SKIP() << "runs where there is multicast";
  const auto sink = sink_of(dtrack_to({std::string(group) + ":" + std::to_string(member.port())}));
  ASSERT_TRUE(sink);
  sink->publish(somebody(3));
  EXPECT_TRUE(member.next().starts_with("fr 3\r\n"));
}

TEST(DtrackOutput, ReachesAGroupByTheInterfaceItIsGiven) {
  const char* group = "239.255.77.79";
  DatagramReceiver member(true);
  const bool joined = member.join(group, "127.0.0.1");
  OutputsConfig config = dtrack_to({std::string(group) + ":" + std::to_string(member.port())});
  // 0 hops: the datagram does not leave this host.
  config.dtrack.protocol.multicast = {"127.0.0.1", 0};
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(somebody(3));
  const std::string heard = joined ? member.next(1000) : "";
  if (heard.empty()) GTEST_SKIP() << "runs where loopback has multicast";
  EXPECT_TRUE(heard.starts_with("fr 3\r\n"));
}

TEST(DtrackOutput, IgnoresWhatIsSaidToItsPort) {
  DatagramReceiver receiver;
  const OutputsConfig config = dtrack_to({receiver.target()});
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  DatagramReceiver stranger;
  for (int i = 0; i < 200; ++i) {
    stranger.say("fw4dtsdkc\0"s, static_cast<std::uint16_t>(config.dtrack.protocol.source_port));
  }
  sink->publish(somebody(1));
  EXPECT_FALSE(receiver.next().empty());
  EXPECT_EQ(stranger.next(300), "");
}

TEST(DtrackOutput, SendsToTheClientInControlAtThePortItOpened) {
  for (const bool allowed : {true, false}) {
    OutputsConfig config = dtrack_to({});
    dtrack::Settings& settings = config.dtrack.protocol;
    settings.commands = true;
    settings.send_to_client = allowed;
    // With port 0 the client would not know the port.
    settings.command.port = outlet::testing::free_port();
    const auto sink = sink_of(config);
    ASSERT_TRUE(sink);
    RawClient commands(static_cast<std::uint16_t>(settings.command.port));
    commands.say("dtrack2 tracking start\0"s);
    ASSERT_EQ(commands.hear_until("\0"s), "dtrack2 ok\0"s);
    DatagramReceiver client;
    client.say("fw4dtsdkc\0"s, static_cast<std::uint16_t>(settings.source_port));
    sink->publish(somebody(5));
    EXPECT_EQ(client.next(allowed ? 10'000 : 300).starts_with("fr 5\r\n"), allowed);
    EXPECT_EQ(sink->counters().clients, 1u);
    commands.say("dtrack2 tracking stop\0"s);
    ASSERT_EQ(commands.hear_until("\0"s), "dtrack2 ok\0"s);
    sink->publish(somebody(6));
    EXPECT_EQ(client.next(300), "");
  }
}

TEST(VmcOutput, SendsBundlesOfThePersonInItsSlot) {
  DatagramReceiver receiver;
  OutputsConfig config;
  config.vmc.common.enabled = true;
  config.vmc.protocol.targets = {receiver.target()};
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(somebody(1));
  std::size_t bones = 0;
  for (int datagrams = 0; datagrams < 2; ++datagrams) {
    const std::string bytes = receiver.next();
    for (const auto& message : outlet::testing::OscReader(bytes).packet()) {
      bones += message.address == "/VMC/Ext/Bone/Pos" ? 1 : 0;
    }
  }
  EXPECT_EQ(bones, 22u);
}

TEST(VmcOutput, SaysThatNobodyIsInAnEmptySlot) {
  DatagramReceiver receiver;
  OutputsConfig config;
  config.vmc.common.enabled = true;
  config.vmc.protocol.targets = {receiver.target()};
  config.vmc.protocol.slot = 3;
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(somebody(1));
  const auto messages = outlet::testing::OscReader(receiver.next()).packet();
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_EQ(messages.at(0).numbers.back(), 0.0);
}

TEST(VmcOutput, EndsWithALastOkThatNothingIsLoaded) {
  DatagramReceiver receiver;
  OutputsConfig config;
  config.vmc.common.enabled = true;
  config.vmc.protocol.targets = {receiver.target()};
  auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(somebody(1));
  (void)receiver.next();
  (void)receiver.next();
  sink.reset();
  const auto messages = outlet::testing::OscReader(receiver.next()).packet();
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages.at(0).address, "/VMC/Ext/OK");
  EXPECT_EQ(messages.at(0).numbers, (std::vector<double>{0, 0, 0, 0}));
}

/// Two persons a metre apart, in slots 0 and 1.
std::shared_ptr<const Snapshot> two_people() {
  auto s = std::make_shared<Snapshot>(*somebody(1));
  s->bodies.push_back(s->bodies[0]);
  s->bodies[1].id = {2};
  s->bodies[1].slot = 1;
  s->bodies[1].skeleton = chorus::testing::standing_person({2, 0, 2});
  return s;
}

TEST(VmcOutput, SendsEachPersonToTargetsOfItsOwn) {
  DatagramReceiver first;
  DatagramReceiver second;
  OutputsConfig config;
  config.vmc.common.enabled = true;
  config.vmc.protocol.targets = {first.target()};
  config.vmc.protocol.persons = {{1, {second.target()}}};
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(two_people());
  const auto hips_x = [](DatagramReceiver& receiver) {
    for (const auto& message : outlet::testing::OscReader(receiver.next()).packet()) {
      if (!message.texts.empty() && message.texts.at(0) == "Hips") return message.numbers.at(0);
    }
    return 0.0;
  };
  EXPECT_NEAR(hips_x(first), 1.0, 1e-6);
  EXPECT_NEAR(hips_x(second), 2.0, 1e-6);
}

TEST(VrChatOutput, SendsEachPersonToTargetsOfItsOwn) {
  DatagramReceiver first;
  DatagramReceiver second;
  OutputsConfig config;
  config.vrchat.common.enabled = true;
  config.vrchat.protocol.targets = {first.target()};
  config.vrchat.protocol.persons = {{1, {second.target()}}};
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(two_people());
  const auto hip_x = [](DatagramReceiver& receiver) {
    return outlet::testing::OscReader(receiver.next()).packet().at(0).numbers.at(0);
  };
  EXPECT_NEAR(hip_x(first), 1.0, 1e-6);
  EXPECT_NEAR(hip_x(second), 2.0, 1e-6);
}

TEST(VrChatOutput, SendsOneMessageADatagram) {
  DatagramReceiver receiver;
  OutputsConfig config;
  config.vrchat.common.enabled = true;
  config.vrchat.protocol.targets = {receiver.target()};
  const auto sink = sink_of(config);
  ASSERT_TRUE(sink);
  sink->publish(somebody(1));
  const auto first = outlet::testing::OscReader(receiver.next()).packet();
  EXPECT_EQ(first.at(0).address, "/tracking/trackers/1/position");
  EXPECT_EQ(first.at(0).numbers.at(2), -2.0);
  for (int i = 1; i < 18; ++i) EXPECT_FALSE(receiver.next().empty()) << i;
  EXPECT_EQ(receiver.next(200), "");
}

}  // namespace
}  // namespace chorus::outputs
