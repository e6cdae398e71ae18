// The configuration's section "outputs": all off by default, every mistake reported by name.
#include "fusion-server/outputs/outputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/net/asio.h"
#include "fusion-server/outlet/datagram_sender.h"
#include "tests/support/matchers.h"

namespace chorus::outputs {
namespace {

using ::testing::AllOf;
using testing::FailsWith;
using ::testing::HasSubstr;
using testing::IsOk;

Result<OutputsConfig> read(std::string_view text) {
  auto root = ConfigReader::parse(text, "test.json");
  if (!root) return pass(root);
  OutputsConfig config;
  read_outputs(root->child("outputs"), config);
  if (auto ok = root->finish(); !ok) return pass(ok);
  return config;
}

TEST(Outputs, AreAllOffByDefault) {
  const auto config = read("{}");
  ASSERT_THAT(config, IsOk());
  const auto sinks = open_outputs(*config, {std::make_shared<SystemClock>()});
  ASSERT_THAT(sinks, IsOk());
  EXPECT_TRUE(sinks->empty());
}

TEST(Outputs, AreSwitchedOnOneByOne) {
  const auto config = read(
      R"({"outputs": {"mxtp": {"enabled": true, "latency": "predicted", "targets": ["127.0.0.1:9"]}}})");
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->mxtp.common.latency, outlet::Latency::Predicted);
  const auto sinks = open_outputs(*config, {std::make_shared<SystemClock>()});
  ASSERT_THAT(sinks, IsOk());
  ASSERT_EQ(sinks->size(), 1u);
  EXPECT_EQ(sinks->front()->name(), "mxtp");
}

TEST(Outputs, ShareTheSlotsOfTheOneThatShowsFewest) {
  EXPECT_EQ(slots_of_all(OutputsConfig{}), 6u) << "as a single output has by default";
  const auto config = read(R"({"outputs": {"mxtp": {"enabled": true, "max_persons": 9},
      "vmc": {"enabled": true, "max_persons": 8}, "vrpn": {"max_persons": 2}}})");
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(slots_of_all(*config), 8u) << "vrpn is off";
}

TEST(Outputs, NameAnUnknownProtocolAndABadTarget) {
  const auto unknown = read(R"({"outputs": {"mxpt": {"enabled": true}}})");
  ASSERT_FALSE(unknown);
  EXPECT_NE(to_string(unknown.error()).find("outputs.mxpt"), std::string::npos);
  const auto bad = read(R"({"outputs": {"mxtp": {"targets": ["localhost"]}}})");
  ASSERT_FALSE(bad);
  EXPECT_NE(to_string(bad.error()).find("HOST:PORT"), std::string::npos);
}

TEST(Outputs, NatNetsGroupIsOne) {
  const auto config = read(R"({"outputs": {"natnet": {"transmission": "multicast",
      "group": "239.1.2.3", "skeleton_coordinates": "global", "rigid_bodies": false}}})");
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->natnet.protocol.transmission, natnet::Transmission::Multicast);
  EXPECT_EQ(config->natnet.protocol.models.skeleton_coordinates, natnet::Coordinates::Global);
  EXPECT_FALSE(config->natnet.protocol.models.rigid_bodies);
  for (const char* wrong : {"127.0.0.1", "239.255.42", "ff02::1", "group"}) {
    const auto bad = read(std::string(R"({"outputs": {"natnet": {"group": ")") + wrong + R"("}}})");
    ASSERT_FALSE(bad) << wrong;
    EXPECT_NE(to_string(bad.error()).find("outputs.natnet.group"), std::string::npos);
  }
}

TEST(Outputs, AnUnknownHostFailsWithTheOutputsName) {
  auto config =
      read(R"({"outputs": {"mxtp": {"enabled": true, "targets": ["no.such.invalid:9763"]}}})");
  ASSERT_THAT(config, IsOk());
  const auto sinks = open_outputs(*config, {std::make_shared<SystemClock>()});
  ASSERT_FALSE(sinks);
  EXPECT_NE(sinks.error().context.find("outputs.mxtp"), std::string::npos);
}

TEST(Outputs, ASlotThatNobodyHasIsRefused) {
  for (const char* name : {"vmc", "vrchat"}) {
    const std::string head = std::string(R"({"outputs": {")") + name;
    const auto bad = read(head + R"(": {"slot": 2, "max_persons": 2}}})");
    ASSERT_FALSE(bad) << name;
    EXPECT_NE(to_string(bad.error()).find("max_persons"), std::string::npos);
    EXPECT_THAT(read(head + R"(": {"slot": 2, "max_persons": 3}}})"), IsOk());
  }
}

TEST(Outputs, MorePersonsHaveASlotAndTargetsEach) {
  for (const char* name : {"vmc", "vrchat"}) {
    const std::string head = std::string(R"({"outputs": {")") + name;
    const auto config = read(head + R"(": {"persons": [{"slot": 2, "targets": ["10.0.0.1:9000"]},
        {"slot": 0, "targets": ["10.0.0.2:9000", "10.0.0.3:9000"]}]}}})");
    ASSERT_THAT(config, IsOk());
    const auto& persons =
        name == std::string("vmc") ? config->vmc.protocol.persons : config->vrchat.protocol.persons;
    ASSERT_EQ(persons.size(), 2u);
    EXPECT_EQ(persons[0].slot, 2);
    EXPECT_EQ(persons[1].targets, (std::vector<std::string>{"10.0.0.2:9000", "10.0.0.3:9000"}));
    for (const char* wrong : {R"({"slot": 6, "targets": ["10.0.0.1:9000"]})", R"({"slot": 1})",
                              R"({"slot": 1, "targets": ["10.0.0.1"]})"}) {
      const auto bad = read(head + R"(": {"persons": [)" + wrong + "]}}}");
      ASSERT_FALSE(bad) << wrong;
      EXPECT_NE(to_string(bad.error()).find("persons"), std::string::npos);
    }
  }
}

/// The error of a configuration that can be read but not opened.
std::string opening_error(std::string_view text) {
  const auto config = read(text);
  EXPECT_THAT(config, IsOk());
  const auto sinks = open_outputs(*config, {std::make_shared<SystemClock>()});
  EXPECT_FALSE(sinks);
  return sinks ? "" : to_string(sinks.error());
}

TEST(Outputs, WhatCannotBeOpenedNamesWhatToChange) {
  EXPECT_THAT(opening_error(R"({"outputs": {"vrpn": {"enabled": true, "address": "localhost"}}})"),
              AllOf(HasSubstr("outputs.vrpn"), HasSubstr("numeric")));
  EXPECT_THAT(opening_error(
                  R"({"outputs": {"dtrack": {"enabled": true, "source_port": 0,
                      "command": {"enabled": true, "address": "here", "port": 0}}}})"),
              AllOf(HasSubstr("outputs.dtrack"), HasSubstr("numeric")));
  const auto taken = outlet::DatagramSender::open({.targets = {"127.0.0.1:9"}});
  ASSERT_THAT(taken, IsOk());
  EXPECT_THAT(opening_error(R"({"outputs": {"dtrack": {"enabled": true, "source_port": )" +
                            std::to_string((*taken)->source_port()) + "}}}"),
              AllOf(HasSubstr("outputs.dtrack"), HasSubstr("source_port")));
}

TEST(Outputs, DtracksGroupHasAnInterfaceAndALimit) {
  const auto config =
      read(R"({"outputs": {"dtrack": {"multicast_address": "10.1.2.3", "multicast_hops": 4}}})");
  ASSERT_THAT(config, IsOk());
  EXPECT_EQ(config->dtrack.protocol.multicast, (outlet::Multicast{"10.1.2.3", 4}));
  for (const char* wrong : {R"("multicast_address": "eth0")", R"("multicast_address": "::1")",
                            R"("multicast_hops": 256)", R"("multicast_hops": -1)"}) {
    EXPECT_FALSE(read(std::string(R"({"outputs": {"dtrack": {)") + wrong + "}}}")) << wrong;
  }
  // No host has an address of TEST-NET-1.
  EXPECT_THAT(opening_error(R"({"outputs": {"dtrack": {"enabled": true, "source_port": 0,
                  "targets": ["239.1.2.3:5000"], "multicast_address": "192.0.2.1"}}})"),
              AllOf(HasSubstr("outputs.dtrack"), HasSubstr("multicast_address")));
}

/// A port that is occupied, by TCP and UDP, for the lifetime of this object.
class Taken {
 public:
  Taken() : acceptor_(io_, {asio::ip::address_v4::loopback(), 0}), socket_(io_) {
    socket_.open(net::udp::v4());
    socket_.bind({asio::ip::address_v4::loopback(), acceptor_.local_endpoint().port()});
    acceptor_.listen();
  }
  [[nodiscard]] std::string port() const {
    return std::to_string(acceptor_.local_endpoint().port());
  }

 private:
  asio::io_context io_;
  net::Acceptor acceptor_;
  net::DatagramSocket socket_;
};

TEST(Outputs, APortThatIsTakenNamesItsKey) {
  const Taken taken;
  const auto enabled = [&taken](const std::string& before, const std::string& after) {
    return opening_error(R"({"outputs": {)" + before + taken.port() + after + "}}");
  };
  EXPECT_THAT(enabled(R"("vrpn": {"enabled": true, "port": )", "}"),
              HasSubstr("set outputs.vrpn.port to"));
  EXPECT_THAT(enabled(R"("natnet": {"enabled": true, "command_port": )", "}"),
              HasSubstr("set outputs.natnet.command_port to"));
  EXPECT_THAT(enabled(R"("dtrack": {"enabled": true, "source_port": 0,
                      "command": {"enabled": true, "port": )",
                      "}}"),
              HasSubstr("set outputs.dtrack.command.port to"));
}

TEST(Targets, AreHostAndPort) {
  const auto v6 = outlet::parse_target("[::1]:39539");
  ASSERT_THAT(v6, IsOk());
  EXPECT_EQ(v6->host, "::1");
  EXPECT_EQ(v6->port, 39539);
  for (const char* wrong :
       {"", ":5000", "host", "host:", "host:0", "host:65536", "host:5000x", "[]:5"}) {
    EXPECT_THAT(outlet::parse_target(wrong), FailsWith(ErrorCode::InvalidArgument)) << wrong;
  }
}

}  // namespace
}  // namespace chorus::outputs
