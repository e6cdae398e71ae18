// VRPN over real sockets, connected both ways, with a client that shares no code with ours.
#include "tests/integration/outputs/vrpn_rig.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/matchers.h"

namespace chorus::vrpn {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::VectorNear;
using testing::VrpnClient;

class Vrpn : public test::VrpnRig {
 protected:
  /// The first pose that reaches the client while frames are published.
  std::optional<testing::VrpnMessage> first_pose(VrpnClient& client) {
    std::optional<testing::VrpnMessage> pose;
    publish_until([&] {
      pose = client.next("vrpn_Tracker Pos_Quat", milliseconds(5));
      return pose.has_value() || client.ended();
    });
    return pose;
  }
};

TEST_F(Vrpn, ATcpClientGetsPosesOverTcp) {
  serve();
  VrpnClient client({"Body0"});
  ASSERT_TRUE(client.connect(server->port()));
  const auto message = first_pose(client);
  ASSERT_TRUE(message);
  EXPECT_FALSE(message->by_datagram);
  EXPECT_EQ(message->sender, "Body0");
  const auto pose = pose_of(*message);
  ASSERT_TRUE(pose);
  EXPECT_EQ(pose->position.y(), pose->sensor);
  EXPECT_EQ(client.decoder.error, "");
  EXPECT_EQ(server->counters().clients, 1u);
}

TEST_F(Vrpn, AClientThatAsksByDatagramIsCalledBackAndGetsDatagrams) {
  serve();
  VrpnClient client({"Body1_Head"});
  ASSERT_TRUE(client.request(server->port()));
  std::optional<testing::VrpnMessage> message;
  ASSERT_TRUE(publish_until(
      [&] {
        message = client.next("vrpn_Tracker Pos_Quat", milliseconds(5));
        return message && message->by_datagram;
      },
      2));
  EXPECT_EQ(message->sender, "Body1_Head");
  EXPECT_EQ(pose_of(*message)->sensor, 0);
  EXPECT_THAT(pose_of(*message)->position.head<2>(), VectorNear(Eigen::Vector2d(1, 3), 0));
  EXPECT_EQ(client.decoder.error, "");
  client.ping();
  ASSERT_TRUE(client.next("vrpn_Base pong_message"));
}

TEST_F(Vrpn, WhoNamesAnotherHostsAddressGetsNoDatagramsAnywhere) {
  serve();
  VrpnClient client({"Body0"});
  ASSERT_TRUE(
      client.request(server->port(), "127.0.0.2"));  // connects back to the source all the same
  const auto message = first_pose(client);
  ASSERT_TRUE(message);
  EXPECT_FALSE(message->by_datagram);
}

TEST_F(Vrpn, PingsAreAnsweredBeforeAndBetweenFrames) {
  serve();
  VrpnClient client({"Body0", "Body0_Head"});
  ASSERT_TRUE(client.connect(server->port()));
  client.ping();
  for (const char* name : {"Body0", "Body0_Head"}) {
    const auto pong = client.next(seconds(10));
    ASSERT_TRUE(pong);
    EXPECT_EQ(pong->type, "vrpn_Base pong_message");
    EXPECT_EQ(pong->sender, name);
  }
  ASSERT_TRUE(first_pose(client));
  client.ping();
  ASSERT_TRUE(client.next("vrpn_Base pong_message"));
}

TEST_F(Vrpn, EveryClientGetsEveryFrameOnce) {
  serve();
  VrpnClient by_tcp({"Body0_Neck"});
  VrpnClient by_udp({"Body0_Neck"});
  ASSERT_TRUE(by_tcp.connect(server->port()));
  ASSERT_TRUE(by_udp.request(server->port()));
  ASSERT_TRUE(first_pose(by_tcp));
  ASSERT_TRUE(publish_until([&] {
    const auto message = by_udp.next("vrpn_Tracker Pos_Quat", milliseconds(5));
    return message && message->by_datagram;
  }));
  for (std::uint64_t n = 10'000; n < 10'050; ++n) {
    publish(1, n);
    for (VrpnClient* client : {&by_tcp, &by_udp}) {
      double z = 0;
      while (z < 10'000) {  // skips the frames sent before that
        const auto message = client->next("vrpn_Tracker Pos_Quat");
        ASSERT_TRUE(message);
        z = pose_of(*message)->position.z();
      }
      EXPECT_EQ(z, static_cast<double>(n));
    }
  }
}

TEST_F(Vrpn, RepeatedRequestsOfOneClientMakeOneConnection) {
  serve();
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  const int asking = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(listener, 100), 0);
  ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  const std::string text = "127.0.0.1 " + std::to_string(ntohs(address.sin_port));
  address.sin_port = htons(server->port());
  for (int i = 0; i < 50; ++i) {
    ::sendto(asking, text.c_str(), text.size() + 1, 0, reinterpret_cast<sockaddr*>(&address), size);
  }
  ASSERT_TRUE(wait_until([&] { return server->counters().clients == 1; }));
  VrpnClient other({"Body0"});  // when it is answered, all 50 requests have been read
  ASSERT_TRUE(other.request(server->port()));
  ASSERT_TRUE(first_pose(other));
  EXPECT_EQ(server->counters().clients, 2u);
  int accepted = 0;
  for (int s = 0; (s = ::accept(listener, nullptr, nullptr)) >= 0; ++accepted) ::close(s);
  EXPECT_EQ(accepted, 1);
  ::close(listener);
  ::close(asking);
}

TEST_F(Vrpn, AClientThatLeavesIsForgotten) {
  serve();
  {
    VrpnClient client({"Body0"});
    ASSERT_TRUE(client.request(server->port()));
    ASSERT_TRUE(first_pose(client));
  }
  EXPECT_TRUE(publish_until([&] { return server->counters().clients == 0; }));
}

TEST_F(Vrpn, APortInUseIsNamed) {
  serve();
  ServerOptions options;
  options.port = server->port();
  Server second(options, trackers);
  const auto started = second.start();
  ASSERT_FALSE(started);
  EXPECT_NE(to_string(started.error()).find(std::to_string(server->port())), std::string::npos);
  options.address = "localhost";
  EXPECT_THAT(Server(options, trackers).start(), testing::FailsWith(ErrorCode::InvalidArgument));
}

}  // namespace
}  // namespace chorus::vrpn
