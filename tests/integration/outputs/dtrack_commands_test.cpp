// DTrack's command channel over real sockets: a client like A.R.T.'s SDK, and hostile ones.
#include <functional>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "fusion-server/dtrack/command_server.h"
#include "tests/integration/http/raw_client.h"
#include "tests/support/matchers.h"

namespace chorus::dtrack {
namespace {

using http::test::RawClient;
using testing::FailsWith;
using testing::IsOk;
using namespace std::literals;
using std::chrono::milliseconds;

constexpr auto kAskAccess = "dtrack2 get system access\0"sv;

std::unique_ptr<CommandServer> server_with(CommandServerOptions options = {}) {
  options.port = 0;
  auto server = CommandServer::start(options);
  EXPECT_THAT(server, IsOk());
  return server ? std::move(*server) : nullptr;
}

bool wait_for(const std::function<bool()>& holds) {
  for (int i = 0; i < 2000 && !holds(); ++i) std::this_thread::sleep_for(milliseconds(5));
  return holds();
}

std::string ask(RawClient& client, std::string_view command) {
  client.say(std::string(command) + '\0');
  return client.hear_until("\0"sv);
}

/// Requires that the service still answers a well-behaved client.
void expect_alive(CommandServer& server) {
  ASSERT_TRUE(wait_for([&] { return server.counters().clients == 0; }));
  RawClient client(server.port());
  EXPECT_EQ(ask(client, "dtrack2 get system access"), "dtrack2 set system access full\0"s);
}

TEST(DtrackCommandServer, ServesAClientFromStartToStop) {
  const auto server = server_with();
  RawClient client(server->port());
  EXPECT_EQ(ask(client, "dtrack2 get system access"), "dtrack2 set system access full\0"s);
  EXPECT_EQ(ask(client, "dtrack2 tracking start"), "dtrack2 ok\0"s);
  EXPECT_EQ(ask(client, "dtrack2 get status active"), "dtrack2 set status active mea\0"s);
  ASSERT_TRUE(server->controller().has_value());
  EXPECT_EQ(server->controller()->host, "127.0.0.1");
  EXPECT_EQ(ask(client, "dtrack2 tracking stop"), "dtrack2 ok\0"s);
  EXPECT_FALSE(server->controller().has_value());
  EXPECT_EQ(server->counters().clients, 1u);
}

TEST(DtrackCommandServer, TheOldestConnectionIsInControl) {
  const auto server = server_with();
  auto first = std::make_unique<RawClient>(server->port());
  EXPECT_EQ(ask(*first, "dtrack2 tracking start"), "dtrack2 ok\0"s);
  const auto controller = server->controller();
  RawClient second(server->port());
  EXPECT_EQ(ask(second, "dtrack2 get system access"), "dtrack2 set system access none\0"s);
  EXPECT_NE(ask(second, "dtrack2 tracking stop").find("err 2"), std::string::npos);
  first.reset();
  ASSERT_TRUE(wait_for([&] { return server->counters().clients == 1; }));
  // Tracking ended when the client that had started it left.
  EXPECT_FALSE(server->controller().has_value());
  EXPECT_EQ(ask(second, "dtrack2 tracking start"), "dtrack2 ok\0"s);
  ASSERT_TRUE(server->controller().has_value());
  EXPECT_NE(server->controller(), controller);
}

TEST(DtrackCommandServer, ConnectionsBeyondTheLimitAreClosedAtOnce) {
  const auto server = server_with({.max_connections = 2});
  RawClient first(server->port());
  RawClient second(server->port());
  (void)ask(first, "dtrack2 getmsg");
  (void)ask(second, "dtrack2 getmsg");
  RawClient third(server->port());
  EXPECT_EQ(third.hear_all(), "");
  EXPECT_TRUE(third.ended());
  EXPECT_EQ(server->counters().refused, 1u);
  EXPECT_EQ(ask(first, "dtrack2 getmsg"), "dtrack2 ok\0"s);
}

TEST(DtrackCommandServer, OneHostDoesNotTakeAllPlaces) {
  const auto server = server_with({.max_connections_per_address = 2});
  RawClient first(server->port());
  RawClient second(server->port());
  (void)ask(first, "dtrack2 getmsg");
  (void)ask(second, "dtrack2 getmsg");
  RawClient third(server->port());
  EXPECT_EQ(third.hear_all(), "");
  EXPECT_TRUE(third.ended());
  EXPECT_EQ(server->counters().refused, 1u);
  RawClient another(server->port(), 0, "127.0.0.2");
  EXPECT_EQ(ask(another, "dtrack2 getmsg"), "dtrack2 ok\0"s);
}

TEST(DtrackCommandServer, IdleConnectionsOfAHostMakeRoomForItsOwnClient) {
  const auto server = server_with({.max_connections_per_address = 2});
  RawClient first(server->port());
  RawClient second(server->port());
  ASSERT_TRUE(wait_for([&] { return server->counters().clients == 2; }));
  RawClient third(server->port());
  EXPECT_EQ(ask(third, "dtrack2 getmsg"), "dtrack2 ok\0"s);
  EXPECT_EQ(first.hear_all(), "");
  EXPECT_TRUE(first.ended()) << "it has said nothing, and for longest";
}

TEST(DtrackCommandServer, ACommandThatIsRefusedCanBeSeen) {
  const auto server = server_with();
  RawClient client(server->port());
  (void)ask(client, "dtrack2 self destruct");
  EXPECT_EQ(server->counters().refused, 1u);
  EXPECT_NE(server->counters().last_refusal.find("dtrack2 self destruct"), std::string::npos);
}

TEST(DtrackCommandServer, TenThousandConnectionsCostNobodyElseAnything) {
  const auto server = server_with();
  RawClient client(server->port());
  EXPECT_EQ(ask(client, "dtrack2 tracking start"), "dtrack2 ok\0"s);
  for (int i = 0; i < 10'000; ++i) {
    RawClient another(server->port());
    another.say("dtrack2 getmsg\0"s);
    if (i % 100 == 0) (void)another.hear_until("\0"sv);  // answered or closed: the server keeps up
  }
  EXPECT_EQ(ask(client, "dtrack2 get status active"), "dtrack2 set status active mea\0"s);
  EXPECT_TRUE(server->controller().has_value());
}

TEST(DtrackCommandServer, ALineWithoutAnEndIsCutOff) {
  const auto server = server_with();
  RawClient client(server->port());
  client.say(std::string(201, 'x'));
  EXPECT_EQ(client.hear_all(), "");
  EXPECT_TRUE(client.ended());
  EXPECT_EQ(server->counters().refused, 1u);
  expect_alive(*server);
}

TEST(DtrackCommandServer, AClientThatNeverReadsIsCutOff) {
  const auto server = server_with();
  RawClient client(server->port(), 4096);
  std::string many;
  for (int i = 0; i < 1000; ++i) many += kAskAccess;
  for (int i = 0; i < 5000 && client.say(many); ++i) {
    if (server->counters().refused > 0) break;
  }
  EXPECT_TRUE(wait_for([&] { return server->counters().refused == 1; }));
  expect_alive(*server);
}

TEST(DtrackCommandServer, BinaryNoiseIsAnsweredWithErrorsAndThenCutOff) {
  const auto server = server_with();
  std::mt19937 noise(7);
  for (int i = 0; i < 50; ++i) {
    RawClient client(server->port());
    std::string bytes(5000, '\0');
    for (char& c : bytes) c = static_cast<char>(noise());
    client.say(bytes);
    (void)client.hear_all(milliseconds(2000));
    EXPECT_TRUE(client.ended()) << i;
  }
  EXPECT_GE(server->counters().refused, 50u);
  expect_alive(*server);
}

TEST(DtrackCommandServer, WhoSaysNothingKnownIsClosedAndSoIsWhoFallsSilent) {
  CommandServerOptions options;
  options.first_word = milliseconds(300);
  options.idle = milliseconds(900);
  const auto server = server_with(options);
  RawClient silent(server->port());
  EXPECT_EQ(silent.hear_all(), "");
  EXPECT_TRUE(silent.ended());
  RawClient known(server->port());
  EXPECT_EQ(ask(known, "dtrack2 getmsg"), "dtrack2 ok\0"s);
  EXPECT_EQ(known.hear_all(milliseconds(500)), "");
  EXPECT_FALSE(known.ended());
  EXPECT_EQ(known.hear_all(), "");
  EXPECT_TRUE(known.ended());
}

TEST(DtrackCommandServer, APortThatIsTakenIsNamed) {
  const auto server = server_with();
  CommandServerOptions options;
  options.port = server->port();
  const auto second = CommandServer::start(options);
  ASSERT_THAT(second, FailsWith(ErrorCode::Io));
  EXPECT_NE(second.error().context.find(std::to_string(server->port())), std::string::npos);
}

TEST(DtrackCommandServer, EndsWhileClientsTalk) {
  auto server = server_with();
  RawClient client(server->port());
  client.say("dtrack2 getmsg\0dtrack2 get"s);
  server.reset();
  (void)client.hear_all();
  EXPECT_TRUE(client.ended());
}

}  // namespace
}  // namespace chorus::dtrack
