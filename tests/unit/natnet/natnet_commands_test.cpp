// NatNet's command channel without a socket: what real clients send, and what nobody should send.
#include "fusion-server/natnet/command_desk.h"

#include <fstream>
#include <iterator>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/unit/natnet/natnet_reader.h"

namespace chorus::natnet {
namespace {

using chorus::testing::kStart;
using outlet::testing::NatNetReader;
using namespace std::literals;

const Address kSomebody{0x7F000001, 40000};

Now at(Duration since) { return {SteadyTime{} + 1h + since, kStart + since}; }

std::string request(int message, std::string_view payload = {}) {
  std::string out{static_cast<char>(message), '\0', static_cast<char>(payload.size() & 0xFF),
                  static_cast<char>(payload.size() >> 8)};
  return out.append(payload);
}

std::string captured(const std::string& name) {
  std::ifstream file("tests/data/natnet_capture/" + name + ".bin", std::ios::binary);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The message number of a reply, which is its first 16 bits; -1 if there is none.
int message_in(const Reply& reply) {
  return reply.bytes.empty() ? -1 : NatNetReader(reply.bytes).one<std::uint16_t>();
}

/// Connects like a client that wants frames.
void connect(CommandDesk& desk, const Address& from, const Now& now) {
  (void)desk.answer(request(0), from, now);
  (void)desk.answer(request(10), from, now);
}

DeskOptions with_models(std::size_t bytes = 100) {
  DeskOptions options;
  options.models = message_of(Message::Models, Bytes(bytes));
  return options;
}

TEST(NatNetCommands, AConnectingClientLearnsWhoWeAreAndGetsFrames) {
  CommandDesk desk(with_models());
  const Reply reply = desk.answer(captured("connect"), kSomebody, at(0s));
  ASSERT_EQ(reply.bytes.size(), 4u + 279);
  NatNetReader read(reply.bytes);
  EXPECT_EQ(read.one<std::uint16_t>(), 1);
  EXPECT_EQ(read.one<std::uint16_t>(), 279);
  EXPECT_EQ(read.text(), "Chorus");
  for (int i = 0; i < 256 - 7; ++i) EXPECT_EQ(read.one<char>(), '\0');
  read.one<std::uint32_t>();
  EXPECT_EQ(read.one<std::uint32_t>(), 0x00000103u);  // 3.1.0.0
  EXPECT_EQ(read.one<std::uint64_t>(), 1'000'000'000u);
  EXPECT_EQ(read.one<std::uint16_t>(), 1511);
  EXPECT_EQ(read.one<std::uint8_t>(), 0);
  EXPECT_EQ(read.one<std::uint32_t>(), 0x632AFFEFu);  // 239.255.42.99
  EXPECT_TRUE(read.ended());
  EXPECT_TRUE(desk.clients(at(0s).steady).empty()) << "anybody may have written that";
  (void)desk.answer(request(4), kSomebody, at(0s));
  EXPECT_EQ(desk.clients(at(0s).steady), std::vector{kSomebody});
}

TEST(NatNetCommands, OneDatagramTurnsNothingOnAndTakesNoPlace) {
  for (const int message : {0, 4, 6, 10, 12, 14}) {
    CommandDesk desk(with_models());
    (void)desk.answer(request(message, "12345678"), kSomebody, at(0s));
    EXPECT_TRUE(desk.clients(at(0s).steady).empty()) << message;
  }
  CommandDesk desk(with_models());
  for (std::uint16_t port = 1; port <= 100; ++port)
    (void)desk.answer(request(0), {kSomebody.host + port, port}, at(0s));
  connect(desk, kSomebody, at(0s));
  EXPECT_EQ(desk.clients(at(0s).steady), std::vector{kSomebody});
}

TEST(NatNetCommands, WhatIsSaidLongAfterAConnectionIsAFirstWordAgain) {
  CommandDesk desk(with_models());
  (void)desk.answer(request(0), kSomebody, at(0s));
  (void)desk.answer(request(4), kSomebody, at(11s));
  EXPECT_TRUE(desk.clients(at(11s).steady).empty());
}

TEST(NatNetCommands, OneHostDoesNotTakeAllPlaces) {
  CommandDesk desk(with_models());
  for (std::uint16_t port = 1; port <= 4; ++port) connect(desk, {kSomebody.host, port}, at(0s));
  const Reply refused = desk.answer(request(0), {kSomebody.host, 5}, at(0s));
  EXPECT_NE(refused.refusal.find("max_clients_per_address"), std::string_view::npos);
  EXPECT_TRUE(refused.bytes.empty());
  EXPECT_EQ(message_in(desk.answer(request(4), {kSomebody.host, 5}, at(0s))), 5);
  connect(desk, {kSomebody.host + 1, 5}, at(0s));
  EXPECT_EQ(desk.clients(at(0s).steady).size(), 5u);
}

TEST(NatNetCommands, AHostThatKnocksAndKnocksHasOneMoreChance) {
  CommandDesk desk(with_models());
  for (std::uint16_t port = 1; port <= 1000; ++port)
    (void)desk.answer(request(0), {kSomebody.host, port}, at(0s));
  connect(desk, {kSomebody.host, 2000}, at(0s));
  EXPECT_EQ(desk.clients(at(0s).steady).size(), 1u);
}

TEST(NatNetCommands, DiscoveryOnlyAsks) {
  CommandDesk desk(with_models());
  EXPECT_EQ(message_in(desk.answer(captured("discovery"), kSomebody, at(0s))), 1);
  EXPECT_TRUE(desk.clients(at(0s).steady).empty());
}

TEST(NatNetCommands, SloppyClientsAreUnderstood) {
  CommandDesk desk(with_models());
  // Forms of "connect": a header alone; "Ping" and NUL; 271 bytes and NUL; no payload announced,
  // but one byte sent.
  for (const std::string& connect :
       {request(0), request(0, "Ping\0"sv), request(0, std::string(271, '\0')) + '\0',
        request(0) + '\0'}) {
    EXPECT_EQ(message_in(desk.answer(connect, kSomebody, at(0s))), 1) << connect.size();
  }
  EXPECT_EQ(message_in(desk.answer(request(4, "\0"sv), kSomebody, at(0s))), 5);
}

TEST(NatNetCommands, AnEchoCarriesTheClientsNumberAndOurTime) {
  CommandDesk desk(with_models());
  NatNetReader read(desk.answer(captured("echorequest"), kSomebody, at(3s)).bytes);
  EXPECT_EQ(read.one<std::uint32_t>(), 0x0010000Du);
  EXPECT_EQ(read.one<std::uint64_t>(), 0x109A664Eu);
  EXPECT_EQ(read.one<std::uint64_t>(), static_cast<std::uint64_t>(to_unix_ns(kStart + 3s)));
  EXPECT_TRUE(read.ended());
}

TEST(NatNetCommands, TheNewestFrameIsGivenOnRequest) {
  CommandDesk desk(with_models());
  EXPECT_EQ(message_in(desk.answer(request(6), kSomebody, at(0s))), -1);
  desk.newest(std::make_shared<const Bytes>(message_of(Message::Frame, Bytes(10))), kStart);
  EXPECT_EQ(message_in(desk.answer(request(6), kSomebody, at(0s))), 7);
}

TEST(NatNetCommands, TextsThatClientsAskBefore) {
  CommandDesk desk(with_models());
  const auto frame = std::make_shared<const Bytes>();
  for (int i = 0; i < 100; ++i) desk.newest(frame, kStart + i * 20ms);
  const auto ask = [&](std::string_view text) {
    NatNetReader read(desk.answer(request(2, std::string(text) + '\0'), kSomebody, at(0s)).bytes);
    EXPECT_EQ(read.one<std::uint32_t>(), 0x00040003u) << text;
    return read;
  };
  EXPECT_NEAR(ask("FrameRate").one<float>(), 50.0F, 0.01F);
  EXPECT_EQ(ask("UnitsToMillimeters").one<float>(), 1000.0F);
  EXPECT_EQ(ask("UpAxis").one<std::int32_t>(), 1);
  EXPECT_EQ(ask("AnalogSamplesPerMocapFrame").one<std::int32_t>(), 0);
  EXPECT_EQ(ask("SubscribeToData,Skeleton,Body0").one<std::int32_t>(), 0);
  for (const char* unknown : {"TestRequest", "", "SetProperty,,Skeleton Coordinates,false"}) {
    const Reply reply = desk.answer(request(2, unknown), kSomebody, at(0s));
    EXPECT_EQ(message_in(reply), 100) << unknown;
    EXPECT_FALSE(reply.refusal.empty());
  }
}

TEST(NatNetCommands, WhatNobodyKnowsIsUnrecognizedAndAnswersAreNot) {
  CommandDesk desk(with_models());
  for (const int unknown : {15, 55, 99, 101, 127}) {
    EXPECT_EQ(message_in(desk.answer(request(unknown), kSomebody, at(0s))), 100);
  }
  // Messages that are answers get no answer: two servers that get each other's address must not
  // answer each other forever.
  for (const int answer : {1, 3, 5, 7, 8, 11, 13, 100}) {
    const Reply reply = desk.answer(request(answer, "12345678"), kSomebody, at(0s));
    EXPECT_EQ(message_in(reply), -1) << answer;
    EXPECT_FALSE(reply.refusal.empty());
  }
}

TEST(NatNetCommands, MalformedDatagramsAreNotAnswered) {
  CommandDesk desk(with_models());
  const std::string announced_more = "\0\0\x10\0abc"s;
  for (const std::string& wrong : {""s, "\0"s, "\4\0\0"s, announced_more, request(12, "1234567"),
                                   request(0, std::string(1021, 'x'))}) {
    const Reply reply = desk.answer(wrong, kSomebody, at(0s));
    EXPECT_TRUE(reply.bytes.empty()) << wrong.size();
    EXPECT_EQ(reply.refusal, "malformed") << wrong.size();
  }
  EXPECT_TRUE(desk.clients(at(0s).steady).empty());
}

TEST(NatNetCommands, ClientsAreForgottenUnlessSomethingIsHeardOfThem) {
  CommandDesk desk(with_models());
  const Address other{0x7F000001, 40001};
  connect(desk, kSomebody, at(0s));
  connect(desk, other, at(0s));
  EXPECT_EQ(message_in(desk.answer(request(10), kSomebody, at(9s))), -1);
  EXPECT_EQ(desk.clients(at(10s).steady).size(), 2u);
  EXPECT_EQ(desk.clients(at(11s).steady), std::vector{kSomebody});
  EXPECT_EQ(desk.clients(at(20s).steady), std::vector<Address>{});
  // If the server was restarted or has forgotten a client, two keep-alives of that client are
  // enough.
  (void)desk.answer(request(10), other, at(21s));
  (void)desk.answer(request(10), other, at(22s));
  EXPECT_EQ(desk.clients(at(22s).steady), std::vector{other});
  (void)desk.answer(request(9), other, at(22s));
  EXPECT_TRUE(desk.clients(at(22s).steady).empty());
  (void)desk.answer(request(10), other, at(22s));
  EXPECT_TRUE(desk.clients(at(22s).steady).empty()) << "it begins anew";
}

TEST(NatNetCommands, InMulticastOnlyWhoKeepsAliveGetsFramesOfItsOwn) {
  DeskOptions options = with_models();
  options.info.multicast = true;
  CommandDesk desk(std::move(options));
  const Reply reply = desk.answer(request(0), kSomebody, at(0s));
  EXPECT_EQ(reply.bytes.at(4 + 256 + 4 + 4 + 8 + 2), 1);
  (void)desk.answer(request(4), kSomebody, at(0s));
  EXPECT_TRUE(desk.clients(at(0s).steady).empty());
  (void)desk.answer(request(10), kSomebody, at(0s));
  (void)desk.answer(request(10), kSomebody, at(1s));
  EXPECT_EQ(desk.clients(at(1s).steady).size(), 1u);
}

TEST(NatNetCommands, AFloodFromManyAddressesCostsThoseWhoAreThereNothing) {
  CommandDesk desk(with_models());
  connect(desk, kSomebody, at(0s));
  std::size_t refused = 0;
  for (std::uint32_t i = 0; i < 100'000; ++i) {
    const Address stranger{0x0A000000 + i, static_cast<std::uint16_t>(1024 + i % 60000)};
    for (const int message : {i % 2 == 0 ? 0 : 10, 10}) {
      refused += desk.answer(request(message), stranger, at(1s)).refusal.empty() ? 0 : 1;
    }
  }
  const auto clients = desk.clients(at(1s).steady);
  EXPECT_EQ(clients.size(), 16u);
  EXPECT_NE(std::find(clients.begin(), clients.end(), kSomebody), clients.end());
  EXPECT_GE(refused, 2 * (100'000u - 15));
}

TEST(NatNetCommands, AllAnswersTogetherAreLimited) {
  CommandDesk desk(with_models(40'000));
  std::size_t said = 0;
  for (int i = 0; i < 1000; ++i) {
    const Address anybody{static_cast<std::uint32_t>(i), 1000};
    said += desk.answer(request(4), anybody, at(i * 1ms)).bytes.size();
  }
  EXPECT_GT(said, 500'000u);             // the initial allowance
  EXPECT_LE(said, 524'288u + 262'144u);  // the initial allowance and that of one second
  EXPECT_EQ(message_in(desk.answer(request(4), kSomebody, at(10s))), 5);
}

TEST(NatNetCommands, NoiseNeverSurprises) {
  CommandDesk desk(with_models());
  std::mt19937 noise(7);
  for (int i = 0; i < 200'000; ++i) {
    std::string bytes(noise() % 64, '\0');
    for (char& c : bytes) c = static_cast<char>(noise());
    if (bytes.size() > 1 && i % 2 == 0) bytes[1] = '\0';  // a message number that may be known
    const Address from{static_cast<std::uint32_t>(noise() % 100),
                       static_cast<std::uint16_t>(noise() % 100)};
    const Reply reply = desk.answer(bytes, from, at(i * 1us));
    ASSERT_LE(reply.bytes.size(), 4u + 279);
  }
  EXPECT_LE(desk.clients(at(1s).steady).size(), 16u);
}

}  // namespace
}  // namespace chorus::natnet
