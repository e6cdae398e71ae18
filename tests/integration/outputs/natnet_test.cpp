// A NatNet server over real sockets: clients of both kinds, and hostile ones.
#include <atomic>
#include <functional>
#include <memory>
#include <new>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "fusion-server/natnet/natnet_server.h"
#include "fusion-server/outputs/outputs.h"
#include "tests/integration/outputs/datagram_receiver.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::natnet {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using outlet::testing::DatagramReceiver;
using namespace std::literals;

const std::string kConnect = "\0\0\0\0"s;
const std::string kModels = "\4\0\0\0"s;
const std::string kFrame = "\6\0\0\0"s;
const std::string kKeepAlive = "\x0A\0\0\0"s;
const std::string kDisconnect = "\x09\0\0\0"s;

bool wait_for(const std::function<bool()>& holds) {
  for (int i = 0; i < 2000 && !holds(); ++i) std::this_thread::sleep_for(5ms);
  return holds();
}

ServerOptions options() {
  ServerOptions options;
  options.command_port = 0;
  options.clock = std::make_shared<SystemClock>();
  options.desk.models = message_of(Message::Models, Bytes(100));
  return options;
}

std::unique_ptr<Server> server_with(ServerOptions given) {
  auto server = Server::start(std::move(given));
  EXPECT_THAT(server, IsOk());
  return server ? std::move(*server) : nullptr;
}

/// Publishes a frame whose first byte is `number`.
void publish(Server& server, char number, std::size_t bytes = 60) {
  Bytes payload(bytes);
  payload.front() = number;
  server.publish(std::make_shared<const Bytes>(message_of(Message::Frame, payload)),
                 chorus::testing::kStart);
}

std::string ask(DatagramReceiver& client, const Server& server, const std::string& what) {
  client.say(what, server.port());
  return client.next();
}

/// Connects like a client that wants frames; its second message has been read on return.
std::string connect(DatagramReceiver& client, const Server& server) {
  std::string info = ask(client, server, kConnect);
  (void)ask(client, server, kModels);
  return info;
}

void expect_alive(Server& server) {
  DatagramReceiver client;
  std::string heard;
  for (int i = 0; i < 40 && heard.empty(); ++i) {  // a full queue of the system drops requests
    client.say("\x0E\0\0\0"s, server.port());
    heard = client.next(250);
  }
  EXPECT_EQ(heard.size(), 283u);
}

TEST(NatNetServer, AClientGetsFramesWhereItConnectedFrom) {
  const auto server = server_with(options());
  DatagramReceiver client;
  EXPECT_EQ(ask(client, *server, kConnect).size(), 283u);
  EXPECT_EQ(client.sender_port(), server->port());
  EXPECT_EQ(ask(client, *server, kModels).size(), 104u);
  publish(*server, 'a');
  EXPECT_EQ(client.next().substr(0, 5), "\7\0\x3C\0a"s);
  EXPECT_EQ(client.sender_port(), server->port());
  EXPECT_TRUE(wait_for([&] { return server->counters().clients == 1; }));
  EXPECT_EQ(ask(client, *server, kFrame).substr(0, 5), "\7\0\x3C\0a"s);
  client.say(kDisconnect, server->port());
  // This answer shows that earlier messages have been read.
  EXPECT_EQ(ask(client, *server, "\x0E\0\0\0"s).size(), 283u);
  publish(*server, 'b');
  EXPECT_EQ(client.next(200), "");
  EXPECT_TRUE(wait_for([&] { return server->counters().clients == 0; }));
}

/// A clock that fails once, then stands still.
class ClockThatFailsOnce final : public Clock {
 public:
  [[nodiscard]] Timestamp now() const override {
    if (!failed_.exchange(true)) throw std::bad_alloc();
    return from_unix_ns(0x0123'4567'89AB'CDEF);
  }

 private:
  mutable std::atomic<bool> failed_ = false;
};

TEST(NatNetServer, WhatIsThrownOverARequestIsNotTheEndOfRequests) {
  ServerOptions given = options();
  given.clock = std::make_shared<ClockThatFailsOnce>();
  const auto server = server_with(std::move(given));
  DatagramReceiver client;
  client.say(kConnect, server->port());
  EXPECT_EQ(client.next(300), "");
  const std::string echoed = ask(client, *server, "\x0C\0\x08\0"s + "\1\2\3\4\5\6\7\0"s);
  EXPECT_EQ(echoed, "\x0D\0\x10\0\1\2\3\4\5\6\7\0"s + "\xEF\xCD\xAB\x89\x67\x45\x23\x01"s);
}

TEST(NatNetServer, OneDatagramBringsNoMoreThanItsAnswer) {
  const auto server = server_with(options());
  DatagramReceiver victim;
  EXPECT_EQ(ask(victim, *server, kConnect).size(), 283u);
  for (int i = 0; i < 10; ++i) publish(*server, 'a');
  EXPECT_EQ(victim.next(200), "");
  EXPECT_EQ(server->counters().clients, 0u);
}

TEST(NatNetServer, WhoNeverConnectedGetsNothing) {
  const auto server = server_with(options());
  DatagramReceiver client;
  EXPECT_EQ(ask(client, *server, kModels).size(), 104u);
  publish(*server, 'a');
  EXPECT_EQ(client.next(200), "");
}

TEST(NatNetServer, AClientThatFallsSilentIsForgotten) {
  ServerOptions given = options();
  given.desk.client_timeout = 1s;
  const auto server = server_with(std::move(given));
  DatagramReceiver silent;
  DatagramReceiver alive;
  EXPECT_EQ(connect(silent, *server).size(), 283u);
  EXPECT_EQ(connect(alive, *server).size(), 283u);
  EXPECT_TRUE(wait_for([&] {
    alive.say(kKeepAlive, server->port());
    publish(*server, 'a');
    return server->counters().clients == 1;
  }));
  while (!silent.next(50).empty()) continue;
  while (!alive.next(50).empty()) continue;
  publish(*server, 'z');
  EXPECT_EQ(alive.next().substr(0, 5), "\7\0\x3C\0z"s);
  EXPECT_EQ(silent.next(200), "");
}

TEST(NatNetServer, TheGroupHearsUsByTheAddressWeListenOn) {
  const std::string group = "239.255.77.78";
  DatagramReceiver member(true);
  const bool joined = member.join(group.c_str(), "127.0.0.1");
  ServerOptions given = options();
  given.desk.info.multicast = true;
  given.desk.info.group = {239, 255, 77, 78};
  given.desk.info.data_port = member.port();
  const auto server = server_with(std::move(given));
  DatagramReceiver client;
  EXPECT_EQ(ask(client, *server, kConnect).size(), 283u);
  publish(*server, 'a');
  const std::string heard = joined ? member.next(1000) : "";
  EXPECT_EQ(client.next(200), "");  // the client only asked where frames are sent
  if (heard.empty()) GTEST_SKIP() << "runs where loopback has multicast";
  EXPECT_EQ(heard.substr(0, 5), "\7\0\x3C\0a"s);
}

TEST(NatNetServer, TheLargestFrameArrives) {
  const auto server = server_with(options());
  DatagramReceiver client;
  (void)connect(client, *server);
  publish(*server, 'a', 40'000);
  EXPECT_EQ(client.next().size(), 40'004u);
  EXPECT_EQ(server->counters().failed, 0u);
}

TEST(NatNetServer, ClientsBeyondTheLimitAreTurnedAway) {
  ServerOptions given = options();
  given.desk.max_clients = 2;
  const auto server = server_with(std::move(given));
  std::vector<DatagramReceiver> clients(3);
  EXPECT_EQ(connect(clients[0], *server).size(), 283u);
  EXPECT_EQ(connect(clients[1], *server).size(), 283u);
  clients[2].say(kConnect, server->port());
  EXPECT_TRUE(wait_for([&] { return server->counters().refused == 1; }));
  EXPECT_EQ(clients[2].next(200), "");
  publish(*server, 'a');
  EXPECT_FALSE(clients[1].next().empty());
}

TEST(NatNetServer, NoiseAndOversizeAreCountedAndFramesGoOn) {
  const auto server = server_with(options());
  DatagramReceiver client;
  (void)connect(client, *server);
  DatagramReceiver stranger;
  std::mt19937 noise(7);
  for (int i = 0; i < 5000; ++i) {
    std::string bytes(i % 100 == 0 ? 60'000 : noise() % 300, '\0');
    for (char& c : bytes) c = static_cast<char>(noise());
    stranger.say(bytes, server->port());
    if (i % 500 != 0) continue;
    publish(*server, 'a');
    EXPECT_FALSE(client.next().empty());
  }
  EXPECT_GT(server->counters().refused, 0u);
  EXPECT_LE(server->counters().clients, 2u);
  expect_alive(*server);
}

TEST(NatNetServer, AFloodOfConnectionsLeavesTheClientItsFrames) {
  const auto server = server_with(options());
  DatagramReceiver client;
  (void)connect(client, *server);
  for (int i = 0; i < 400; ++i) {
    DatagramReceiver stranger;
    for (int k = 0; k < 25; ++k) stranger.say(k % 2 == 0 ? kConnect : kModels, server->port());
    if (i % 40 != 0) continue;
    publish(*server, 'a');
    EXPECT_EQ(client.next().substr(0, 2), "\7\0"s);
  }
  EXPECT_LE(server->counters().clients, 16u);
  EXPECT_GT(server->counters().refused, 0u);
}

TEST(NatNetServer, TwoServersDoNotTalkToEachOther) {
  const auto first = server_with(options());
  const auto second = server_with(options());
  // A request with the second server's forged address would make the first server send its answer
  // to the second one.  This test sends that answer itself.
  DatagramReceiver stranger;
  const std::string unrecognized = ask(stranger, *first, "\x37\0\0\0"s);
  EXPECT_EQ(unrecognized, "\x64\0\0\0"s);
  stranger.say(unrecognized, second->port());
  EXPECT_EQ(stranger.next(200), "");
}

TEST(NatNetServer, APortThatIsTakenIsNamed) {
  const auto server = server_with(options());
  ServerOptions given = options();
  given.command_port = server->port();
  const auto second = Server::start(std::move(given));
  ASSERT_THAT(second, FailsWith(ErrorCode::Io));
  EXPECT_NE(second.error().context.find(std::to_string(server->port())), std::string::npos);
}

TEST(NatNetServer, AnAddressIsNumericAndIpV4) {
  for (const char* wrong : {"localhost", "::1", ""}) {
    ServerOptions given = options();
    given.address = wrong;
    EXPECT_THAT(Server::start(std::move(given)), FailsWith(ErrorCode::InvalidArgument)) << wrong;
  }
}

TEST(NatNetServer, EndsWhileClientsTalk) {
  auto server = server_with(options());
  const std::uint16_t port = server->port();
  DatagramReceiver client;
  (void)connect(client, *server);
  for (int i = 0; i < 100; ++i) client.say(kModels, server->port());
  publish(*server, 'a');
  server.reset();
  while (!client.next(50).empty()) {
  }
  client.say(kModels, port);
  EXPECT_EQ(client.next(100), "");
}

TEST(NatNetOutput, ServesWhatFusionMadeUnderItsConfiguration) {
  outputs::OutputsConfig config;
  config.natnet.common.enabled = true;
  config.natnet.common.max_persons = 2;
  config.natnet.protocol.command_port = outlet::testing::free_port();
  auto sinks = outputs::open_outputs(config, {std::make_shared<SystemClock>()});
  ASSERT_THAT(sinks, IsOk());
  ASSERT_EQ(sinks->size(), 1u);
  const auto port = static_cast<std::uint16_t>(config.natnet.protocol.command_port);
  DatagramReceiver client;
  client.say(kConnect, port);
  EXPECT_EQ(client.next().size(), 283u);
  client.say(kModels, port);
  EXPECT_EQ(client.next().substr(4, 4), "\x34\0\0\0"s);  // 52 models
  auto snapshot = std::make_shared<Snapshot>();
  snapshot->sequence = 41;
  snapshot->instant = chorus::testing::kStart;
  snapshot->bodies.resize(1);
  snapshot->bodies[0].slot = 0;
  snapshot->bodies[0].skeleton = chorus::testing::standing_person({1, 0, 2});
  sinks->front()->publish(snapshot);
  const std::string frame = client.next();
  ASSERT_EQ(frame.size(), 4u + 78 + 25 * 38 + 8 + 21 * 38);
  EXPECT_EQ(frame[4], 41);
  EXPECT_TRUE(wait_for([&] { return sinks->front()->counters().clients == 1; }));
  EXPECT_TRUE(wait_for([&] { return sinks->front()->counters().frames == 1; }));
}

TEST(NatNetOutput, TellsThatBonesWereMeasuredAndDescribesThem) {
  outputs::OutputsConfig config;
  config.natnet.common.enabled = true;
  config.natnet.protocol.command_port = outlet::testing::free_port();
  auto sinks = outputs::open_outputs(config, {std::make_shared<SystemClock>()});
  ASSERT_THAT(sinks, IsOk());
  const auto port = static_cast<std::uint16_t>(config.natnet.protocol.command_port);
  DatagramReceiver client;
  client.say(kConnect, port);
  EXPECT_EQ(client.next().size(), 283u);
  client.say(kModels, port);
  const std::string before = client.next();
  auto giant = chorus::testing::standing_person({1, 0, 2});
  for (Joint& joint : giant.joints) joint.position *= 1.2;
  bool changed = false;
  for (std::uint64_t i = 0; i < 1000 && !changed; ++i) {
    auto snapshot = std::make_shared<Snapshot>();
    snapshot->sequence = i;
    snapshot->instant = chorus::testing::kStart + 33ms * i;
    snapshot->bodies.resize(1);
    snapshot->bodies[0].slot = 0;
    snapshot->bodies[0].skeleton = giant;
    sinks->front()->publish(snapshot);
    const std::string frame = client.next();  // receives them one by one, so that none is dropped
    ASSERT_EQ(frame.substr(0, 2), "\7\0"s);
    changed = frame[frame.size() - 6] == 2;
    EXPECT_TRUE(!changed || i + 1 >= BoneLengths::kFrames) << i;
  }
  EXPECT_TRUE(changed);
  client.say(kModels, port);
  std::string heard;
  do heard = client.next();
  while (heard.substr(0, 2) == "\7\0"s);
  EXPECT_EQ(heard.size(), before.size());
  EXPECT_NE(heard, before);
}

}  // namespace
}  // namespace chorus::natnet
