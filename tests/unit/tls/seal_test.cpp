#include "common/tls/seal.h"

#include <array>
#include <random>

#include <gmock/gmock.h>

#include "tests/support/workshop_authority.h"

namespace chorus::tls {
namespace {

using ::testing::HasSubstr;
using Step = Seal::Step;

/// Carries bytes in both directions, `piece` at a time, until neither side has more to send.
struct Wire {
  void carry() {
    for (bool moved = true; moved;) {
      moved = pass(client, server);
      step_server();
      moved = pass(server, client) || moved;
      step_client();
    }
  }
  bool shake_hands() {
    step_client();
    carry();
    return client_step == Step::Done && server_step == Step::Done;
  }
  bool pass(Seal& from, Seal& to) const {
    const std::string bytes = from.take_output();
    for (std::size_t at = 0; at < bytes.size(); at += piece)
      to.receive(std::string_view(bytes).substr(at, piece));
    return !bytes.empty();
  }
  void step_client() {
    if (client_step == Step::NeedsInput) client_step = client.handshake();
  }
  void step_server() {
    if (server_step == Step::NeedsInput) server_step = server.handshake();
  }

  Seal client;
  Seal server;
  std::size_t piece = 1000000;
  Step client_step = Step::NeedsInput;
  Step server_step = Step::NeedsInput;
};

std::string hear(Seal& seal) {
  std::array<char, 64> room;
  std::string all;
  for (auto heard = seal.read(room); heard.step == Step::Done; heard = seal.read(room))
    all.append(room.data(), heard.size);
  return all;
}

class SealTest : public ::testing::Test {
 protected:
  [[nodiscard]] Wire wire(const std::string& host, const Identity& identity) const {
    return {Seal::of_client(workshop_.trust(), host), Seal::of_server(identity)};
  }
  /// Shakes hands, which the client must refuse; returns its reason.
  [[nodiscard]] std::string objection(Wire wire) const {
    EXPECT_FALSE(wire.shake_hands());
    EXPECT_EQ(wire.client_step, Step::Failed);
    EXPECT_EQ(wire.client.failure().code, ErrorCode::Forbidden) << "programs tell it by that";
    return wire.client.failure().message;
  }

  testing::WorkshopAuthority workshop_;
};

TEST_F(SealTest, SpeaksBothWays) {
  for (const char* host : {"localhost", "127.0.0.1"}) {
    Wire pair = wire(host, workshop_.identity());
    ASSERT_TRUE(pair.shake_hands()) << pair.client.failure().message;
    EXPECT_EQ(pair.client.write("ask"), Step::Done);
    const std::string sealed = pair.client.take_output();
    EXPECT_EQ(sealed.find("ask"), std::string::npos);
    pair.server.receive(sealed);
    EXPECT_EQ(hear(pair.server), "ask");
    EXPECT_EQ(pair.server.write(std::string(100000, 'x')), Step::Done);
    pair.carry();
    EXPECT_EQ(hear(pair.client), std::string(100000, 'x'));
  }
}

TEST_F(SealTest, BytesMayComeOneByOne) {
  Wire pair = wire("localhost", workshop_.identity());
  pair.piece = 1;
  EXPECT_TRUE(pair.shake_hands());
}

TEST_F(SealTest, SaysItsEndAndStillHears) {
  Wire pair = wire("localhost", workshop_.identity());
  ASSERT_TRUE(pair.shake_hands());
  pair.server.say_end();
  EXPECT_EQ(pair.client.write("one more"), Step::Done);
  pair.carry();
  std::array<char, 8> room;
  EXPECT_EQ(pair.client.read(room).step, Step::Ended);
  EXPECT_EQ(hear(pair.server), "one more");
}

TEST_F(SealTest, AnotherNameIsRefusedWithTheNamesThereAre) {
  const auto said = objection(wire("sensor-2", workshop_.identity({"sensor-1", "10.0.0.11"})));
  EXPECT_THAT(said, HasSubstr("is for sensor-1, 10.0.0.11, not for sensor-2"));
  EXPECT_THAT(said, HasSubstr("chorus init certificate sensor-2"));
  EXPECT_THAT(objection(wire("10.0.0.12", workshop_.identity({"10.0.0.11"}))),
              HasSubstr("is for 10.0.0.11, not for 10.0.0.12"));
}

TEST_F(SealTest, AnExpiredCertificateIsRefusedWithItsDay) {
  const Issued old = workshop_.issue_expired({"localhost"});
  const auto said = objection(wire("localhost", Identity::of(old.certificate, old.key).value()));
  EXPECT_THAT(said, HasSubstr("has expired (it was good until 20"));
  EXPECT_THAT(said, HasSubstr("chorus init certificate"));
}

TEST_F(SealTest, AnUnknownAuthorityIsRefusedWithItsName) {
  const testing::WorkshopAuthority stranger;
  const auto said = objection(wire("localhost", stranger.identity()));
  EXPECT_THAT(said, HasSubstr("signed by Test workshop"));
  EXPECT_THAT(said, HasSubstr("not among those in ca.crt"));
}

TEST_F(SealTest, TheSystemDoesNotKnowAWorkshop) {
  Wire pair{Seal::of_client(Trust(), "localhost"), Seal::of_server(workshop_.identity())};
  EXPECT_FALSE(pair.shake_hands());
  EXPECT_THAT(pair.client.failure().message, HasSubstr("the authorities of this system"));
}

TEST_F(SealTest, ItsOwnCertificateMayBeTrusted) {
  const Issued issued = workshop_.issue({"localhost"});
  Wire pair{Seal::of_client(Trust::of(issued.certificate, "pin").value(), "localhost"),
            Seal::of_server(Identity::of(issued.certificate, issued.key).value())};
  EXPECT_TRUE(pair.shake_hands());
}

TEST_F(SealTest, WhoSpeaksNoTlsIsTold) {
  Seal server = Seal::of_server(workshop_.identity());
  server.receive("GET / HTTP/1.1\r\nHost: a\r\n\r\n");
  EXPECT_EQ(server.handshake(), Step::Failed);
  EXPECT_THAT(server.failure().message, HasSubstr("https://"));
  Seal client = Seal::of_client(workshop_.trust(), "localhost");
  EXPECT_EQ(client.handshake(), Step::NeedsInput);
  client.receive("HTTP/1.1 400 Bad Request\r\n\r\n");
  EXPECT_EQ(client.handshake(), Step::Failed);
  EXPECT_THAT(client.failure().message, HasSubstr("http://"));
}

TEST_F(SealTest, AHandshakeThatIsEndedHasFailed) {
  Seal client = Seal::of_client(workshop_.trust(), "localhost");
  ASSERT_EQ(client.handshake(), Step::NeedsInput);
  client.receive(std::string_view("\x15\x03\x03\x00\x02\x01\x00", 7));  // "I close"
  EXPECT_EQ(client.handshake(), Step::Failed);
  EXPECT_THAT(client.failure().message, HasSubstr("handshake"));
}

TEST_F(SealTest, GarbageFailsAndNothingElse) {
  std::minstd_rand random(7);
  Seal hello_of = Seal::of_client(workshop_.trust(), "localhost");
  ASSERT_EQ(hello_of.handshake(), Step::NeedsInput);
  const std::string hello = hello_of.take_output();
  const Identity identity = workshop_.identity();
  int failed = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string bytes = hello.substr(0, random() % (hello.size() + 1));
    for (std::size_t flips = random() % 8; flips > 0 && !bytes.empty(); --flips)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    for (std::size_t more = random() % 64; more > 0; --more)
      bytes.push_back(static_cast<char>(random()));
    Seal server = Seal::of_server(identity);
    server.receive(bytes);
    const Step step = server.handshake();
    EXPECT_NE(step, Step::Done);
    if (step == Step::Failed) ++failed;
    EXPECT_EQ(step == Step::Failed, !server.failure().message.empty());
    std::array<char, 16> room;
    if (step == Step::Failed) {
      EXPECT_NE(server.read(room).step, Step::Done);
    }
  }
  EXPECT_GT(failed, 500);
}

TEST_F(SealTest, ASpoiltRecordEndsIt) {
  Wire pair = wire("localhost", workshop_.identity());
  ASSERT_TRUE(pair.shake_hands());
  ASSERT_EQ(pair.client.write("ask"), Step::Done);
  std::string sealed = pair.client.take_output();
  sealed.back() = static_cast<char>(sealed.back() ^ 1);
  pair.server.receive(sealed);
  std::array<char, 16> room;
  EXPECT_EQ(pair.server.read(room).step, Step::Failed);
}

}  // namespace
}  // namespace chorus::tls
