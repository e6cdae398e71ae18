// Hostile and broken clients of the VRPN server: each is refused or closed, while a good client
// continues to get every frame.
#include "tests/integration/outputs/vrpn_rig.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/outputs/datagram_receiver.h"

namespace chorus::vrpn {
namespace {

using http::test::RawClient;
using std::chrono::milliseconds;
using testing::vrpn_cookie;
using testing::vrpn_description;
using testing::vrpn_message;
using testing::VrpnClient;

class HostileVrpn : public test::VrpnRig {
 protected:
  void SetUp() override {
    ServerOptions options;
    options.limits.handshake = milliseconds(600);
    options.limits.stall = milliseconds(600);
    options.max_clients = 20;
    serve(options);
    ASSERT_TRUE(good.connect(server->port()));
    ASSERT_TRUE(good_is_served());
  }
  /// True if a frame published now reaches the good client.
  bool good_is_served() {
    const auto begun = static_cast<double>(sequence);
    return publish_until([&] {
      good.read();
      bool served = false;
      for (const auto& message : good.decoder.messages) {
        const auto pose = pose_of(message);
        served = served || (pose && pose->position.z() > begun);
      }
      good.decoder.messages.clear();
      return served;
    });
  }
  VrpnClient good{{"Body0_Neck"}};
};

TEST_F(HostileVrpn, WhatIsNoVrpnIsClosed) {
  std::string shorter = vrpn_message(0, 0, "");
  shorter[3] = 23;
  std::string count = vrpn_description(-1, 0, "Body0");
  count[24] = '\x7F';
  const std::vector<std::string> bad{"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n",
                                     std::string(24, '\0'),
                                     vrpn_cookie() + shorter,
                                     vrpn_cookie() + std::string("\x00\x00\xFA\x01", 4),  // 64001
                                     vrpn_cookie() + std::string(64, '\xFF'),
                                     vrpn_cookie() + count,
                                     vrpn_cookie() + vrpn_description(-2, 1 << 20, "x"),
                                     vrpn_cookie() + vrpn_description(-1, -7, "x")};
  for (std::size_t i = 0; i < bad.size(); ++i) {
    RawClient client(server->port());
    ASSERT_TRUE(client.connected());
    client.say(bad[i]);
    (void)client.hear_all();
    EXPECT_TRUE(client.ended()) << i;
    EXPECT_TRUE(wait_until([&] { return server->counters().refused == i + 1; })) << i;
  }
  EXPECT_TRUE(good_is_served());
}

TEST_F(HostileVrpn, HalfACookieIsNotWaitedForLong) {
  RawClient half(server->port());
  RawClient silent(server->port());
  half.say(vrpn_cookie().substr(0, 10));
  for (RawClient* client : {&half, &silent}) {
    (void)client->hear_all();
    EXPECT_TRUE(client->ended());
  }
  EXPECT_EQ(server->counters().refused, 2u);
  EXPECT_TRUE(good_is_served());
}

TEST_F(HostileVrpn, AClientThatNeverReadsIsClosedAndCostsNobodyElse) {
  RawClient deaf(server->port(), 4096);
  deaf.say(vrpn_cookie());
  ASSERT_TRUE(wait_until([&] { return server->counters().clients == 2; }));
  // A client that names no tracker gets all of them: 55 kB a frame for six persons, which soon
  // fills the buffers between it and the server.
  EXPECT_TRUE(publish_until(
      [&] {
        (void)good.next(milliseconds(1));
        return server->counters().clients == 1;
      },
      6));
  EXPECT_GE(server->counters().refused, 1u);
  EXPECT_GT(server->counters().dropped, 0u);  // only the newest frame waits for this client
  EXPECT_TRUE(good_is_served());
}

TEST_F(HostileVrpn, AClientThatPingsAndNeverReadsIsClosed) {
  RawClient deaf(server->port(), 4096);
  std::string pings = vrpn_cookie() + vrpn_description(-1, 0, "Body5") +
                      vrpn_description(-2, 0, "vrpn_Base ping_message");
  for (int i = 0; i < 100; ++i) pings += vrpn_message(0, 0, "");
  const std::string ping = vrpn_message(0, 0, "");
  std::string flood;
  for (int i = 0; i < 1000; ++i) flood += ping;
  deaf.say(pings);
  ASSERT_TRUE(wait_until([&] { return server->counters().clients == 2; }));
  // The client blocks as soon as the server stops reading, because of the answers that wait, and
  // ends when the server closes the connection.
  std::thread saying([&] {
    while (deaf.say(flood)) {
    }
  });
  EXPECT_TRUE(wait_until([&] { return server->counters().clients == 1; }));
  saying.join();
  EXPECT_TRUE(good_is_served());
}

/// Number of bytes that the server accepts from a client that does not read, until it has accepted
/// none for a second or has reached `most`.
std::size_t bytes_taken(http::test::RawClient& client, std::string_view repeated,
                        std::size_t most) {
  std::size_t taken = 0;
  std::size_t begun = 0;  // Offset in `repeated` of the next piece.
  while (taken < most) {
    const std::size_t said = client.say_some(repeated.substr(begun), std::chrono::seconds(1));
    if (said == 0) break;
    taken += said;
    begun = (begun + said) % repeated.size();
  }
  return taken;
}

class PatientVrpn : public test::VrpnRig {};

// Two limits protect the server from such a client: `stall` closes it, and kMaxAnswers stops
// reading from it.  With a stall limit of one hour, only kMaxAnswers keeps its answers from growing
// endlessly.
TEST_F(PatientVrpn, FromAClientThatPingsAndNeverReadsNoMoreIsRead) {
  constexpr std::size_t kMax = 32U << 20U;  // The system's own buffers take less than half of it.
  ServerOptions options;
  options.limits.stall = std::chrono::hours(1);
  serve(options);
  RawClient deaf(server->port(), 4096);
  ASSERT_TRUE(deaf.say(vrpn_cookie() + vrpn_description(-1, 0, "Body5") +
                       vrpn_description(-2, 0, "vrpn_Base ping_message")));
  std::string pings;
  for (int i = 0; i < 1000; ++i) pings += vrpn_message(0, 0, "");
  EXPECT_LT(bytes_taken(deaf, pings, kMax), kMax);
  EXPECT_EQ(server->counters().clients, 1u);
  // The client reads its answers now, so the server reads again.
  std::size_t heard = 0;
  while (deaf.say_some(pings.substr(0, 24), std::chrono::milliseconds(0)) == 0 && heard < kMax) {
    const std::size_t more = deaf.hear_some(std::chrono::seconds(10)).size();
    ASSERT_GT(more, 0u);
    heard += more;
  }
  EXPECT_GT(heard, 0u);
}

TEST_F(HostileVrpn, TenThousandRequestsMakeFewConnections) {
  const int asking = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(server->port());
  const auto say = [&](const std::string& text) {
    ::sendto(asking, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&address),
             sizeof address);
  };
  for (int i = 0; i < 10'000; ++i) {
    // These ports are above those that the system assigns to others.
    say("127.0.0.1 " + std::to_string(61'000 + i % 4'500) + std::string(1, '\0'));
    if (i % 100 == 0) say(std::string(static_cast<std::size_t>(i % 1400), '\xFF'));
  }
  EXPECT_TRUE(good_is_served());
  EXPECT_GT(server->counters().refused, 100u);
  EXPECT_LE(server->counters().clients, 20u);
  EXPECT_TRUE(wait_until([&] { return server->counters().clients == 1; }));
  ::close(asking);
}

/// Keeps asking the server, from 127.0.0.2, to connect to ports where nobody listens.
class Flood {
 public:
  explicit Flood(std::uint16_t server) : asking_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in own{};
    own.sin_family = AF_INET;
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);
    ::bind(asking_, reinterpret_cast<sockaddr*>(&own), sizeof own);
    thread_ = std::jthread([this, server](const std::stop_token& stop) { run(stop, server); });
  }
  ~Flood() {
    thread_ = {};
    ::close(asking_);
  }
  Flood(const Flood&) = delete;
  Flood& operator=(const Flood&) = delete;

 private:
  void run(const std::stop_token& stop, std::uint16_t server) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    to.sin_port = htons(server);
    for (int i = 0; !stop.stop_requested(); ++i) {
      const std::string text = "127.0.0.2 " + std::to_string(1024 + i % 60'000);
      ::sendto(asking_, text.c_str(), text.size() + 1, 0, reinterpret_cast<sockaddr*>(&to),
               sizeof to);
      if (i % 5 == 0) std::this_thread::sleep_for(milliseconds(1));
    }
  }

  int asking_;
  std::jthread thread_;
};

TEST_F(HostileVrpn, AFloodOfRequestsFromOneHostDoesNotLockOutAnother) {
  const Flood flood(server->port());
  ASSERT_TRUE(wait_until([&] { return server->counters().refused > 500; }));
  // One request might be lucky, so each client asks ten times.
  std::vector<std::unique_ptr<VrpnClient>> others;
  for (int i = 0; i < 14; ++i) {
    others.push_back(std::make_unique<VrpnClient>(std::vector<std::string>{"Body0"}));
    ASSERT_TRUE(others.back()->request(server->port())) << i;
  }
  EXPECT_TRUE(good_is_served());
}

TEST_F(HostileVrpn, ClientsBeyondTheLimitAreTurnedAway) {
  std::vector<std::unique_ptr<VrpnClient>> clients;
  for (int i = 0; i < 19; ++i) {
    clients.push_back(std::make_unique<VrpnClient>(std::vector<std::string>{"Body0"}));
    ASSERT_TRUE(clients.back()->connect(server->port()));
  }
  ASSERT_TRUE(wait_until([&] { return server->counters().clients == 20; }));
  RawClient surplus(server->port());
  (void)surplus.hear_all();
  EXPECT_TRUE(surplus.ended());
  EXPECT_EQ(server->counters().refused, 1u);
  clients.pop_back();
  ASSERT_TRUE(wait_until([&] { return server->counters().clients == 19; }));
  VrpnClient next({"Body0"});
  ASSERT_TRUE(next.connect(server->port()));
  EXPECT_TRUE(wait_until([&] { return server->counters().clients == 20; }));
}

/// The server accepts three connections at a time from each address.
class FairVrpn : public test::VrpnRig {
 protected:
  void SetUp() override {
    ServerOptions options;
    options.max_clients_per_address = 3;
    serve(std::move(options));
  }
};

TEST_F(FairVrpn, IdleConnectionsOfOneHostLeaveTheOthersTheirPlaces) {
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int i = 0; i < 3; ++i) idle.push_back(std::make_unique<RawClient>(server->port()));
  ASSERT_TRUE(wait_until([&] { return server->counters().clients == 3; }));
  RawClient newcomer(server->port());
  EXPECT_EQ(newcomer.hear_until("07.").substr(0, 6), "vrpn: ");
  (void)idle.front()->hear_all();
  EXPECT_TRUE(idle.front()->ended()) << "the one that was idle longest made room";
  EXPECT_EQ(server->counters().clients, 3u);
  outlet::testing::DatagramReceiver asking;
  asking.say(std::string("127.0.0.1 33471\0", 16), server->port());
  ASSERT_TRUE(wait_until([&] { return server->counters().refused >= 2; }));
  RawClient other(server->port(), 0, "127.0.0.2");
  EXPECT_EQ(other.hear_until("07.").substr(0, 6), "vrpn: ");
}

TEST_F(HostileVrpn, NoReplacedByteOfAGoodOpeningStopsTheServer) {
  const std::string opening =
      vrpn_cookie() + vrpn_message(5000, -3, std::string("127.0.0.1\0", 10)) +
      vrpn_description(-1, 0, "Body0") + vrpn_description(-2, 0, "vrpn_Base ping_message") +
      vrpn_message(0, 0, "");
  for (std::size_t at = 0; at < opening.size(); at += 5) {
    std::string changed = opening;
    changed[at] = static_cast<char>(changed[at] ^ '\xA5');
    RawClient client(server->port());
    client.say(changed);
  }
  EXPECT_TRUE(good_is_served());
}

}  // namespace
}  // namespace chorus::vrpn
