// Readers of makers' files, and the SlimeVR protocol.
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/inertial/dot_csv.h"
#include "common/inertial/mtw_log.h"
#include "common/inertial/orientation_table.h"
#include "common/inertial/slimevr.h"

namespace chorus::inertial {
namespace {

const char* const kMtwHead =
    "// Update Rate: "
    "50.0Hz\nPacketCounter,SampleTimeFine,Acc_X,Acc_Y,Acc_Z,Quat_q0,Quat_q1,Quat_q2,Quat_q3\n";

TEST(MtwLog, ReadsQuaternionsAcrossAWrappedCounter) {
  const auto log =
      parse_mtw_log(std::string(kMtwHead) +
                        "65534,,1,2,3,1,0,0,0\n65535,,1,2,3,1,0,0,0\n65535,,1,2,3,1,0,0,0\n"
                        "1,,1,2,3,0.7071068,0,0,0.7071068\n",
                    "a.txt", "B1");
  ASSERT_TRUE(log) << to_string(log.error());
  ASSERT_EQ(log->readings.size(), 3u);
  EXPECT_DOUBLE_EQ(log->rate_hz, 50.0);
  EXPECT_EQ(to_unix_ns(log->readings[2].captured), 60'000'000);
  EXPECT_EQ(log->notes.size(), 2u);  // one lost, one repeated
  // A quarter turn about the file's +z is one about our +y.
  EXPECT_LT(angular_distance(*log->readings[2].inertial_from_sensor *
                                 log->readings[0].inertial_from_sensor->conjugate(),
                             about_y(deg(90))),
            1e-6);
  EXPECT_EQ(*log->readings[0].acceleration, Eigen::Vector3d(1, 2, 3));
}

TEST(MtwLog, ReadsMatricesLikeQuaternions) {
  const auto log = parse_mtw_log(
      "PacketCounter\tMat[1][1]\tMat[2][1]\tMat[3][1]\tMat[1][2]\tMat[2][2]\tMat[3][2]\tMat[1][3]"
      "\tMat[2][3]\tMat[3][3]\n"
      "00472\t0\t1\t0\t-1\t0\t0\t0\t0\t1\n",
      "a.txt", "B1");
  ASSERT_TRUE(log) << to_string(log.error());
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(deg(90), Eigen::Vector3d::UnitZ()));
  EXPECT_LT(angular_distance(*log->readings[0].inertial_from_sensor, y_up_from_z_up() * quarter),
            1e-6);
}

TEST(MtwLog, RefusesByLine) {
  const std::string head = kMtwHead;
  EXPECT_EQ(
      parse_mtw_log(head + "5,,1,2,3,1,0,0,0\n4,,1,2,3,1,0,0,0\n", "a.txt", "B").error().context,
      "a.txt:4");
  EXPECT_EQ(parse_mtw_log(head + "5,,1,2,3,2,0,0,0\n", "a.txt", "B").error().context, "a.txt:3");
  EXPECT_FALSE(parse_mtw_log("PacketCounter,Acc_X\n1,2\n", "a.txt", "B"));
  EXPECT_FALSE(parse_mtw_log("", "a.txt", "B"));
  EXPECT_EQ(mtw_sensor_of("S02-Trial-Walk-1-000_00B40B91"), "00B40B91");
}

TEST(DotCsv, ReadsEulerAnglesAndAWrappedClock) {
  const auto log = parse_dot_csv(
      "sep=,\nDeviceTag:,shank "
      "left\nPacketCounter,SampleTimeFine,Euler_X,Euler_Y,Euler_Z,FreeAcc_X,FreeAcc_Y,FreeAcc_Z\n"
      "1,4294960000,0,0,90,0,0,1\n2,1037,0,0,90,0,0,1\n",
      "dot.csv");
  ASSERT_TRUE(log) << to_string(log.error());
  EXPECT_EQ(log->sensor, "shank left");
  EXPECT_NEAR(log->rate_hz, 1e6 / 8333, 0.1);
  EXPECT_TRUE(log->readings[0].free_acceleration->isApprox(Eigen::Vector3d::UnitY()));
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(deg(90), Eigen::Vector3d::UnitZ()));
  EXPECT_LT(angular_distance(*log->readings[0].inertial_from_sensor, y_up_from_z_up() * quarter),
            1e-6);
  EXPECT_FALSE(parse_dot_csv("PacketCounter,SampleTimeFine,Acc_X\n1,5,2\n", "dot.csv"));
  EXPECT_FALSE(parse_dot_csv("PacketCounter,Euler_X\n1,5\n", "dot.csv"));
}

TEST(OrientationTable, GoesBothWays) {
  const std::string table =
      "DataRate=100.000000\nDataType=Quaternion\nversion=3\nendheader\ntime\tpelvis_imu\ttibia_l_"
      "imu\n"
      "0\t1,0,0,0\t0.6,0.8,0,0\n0.01\t1,0,0,0\t0.6,0,0.8,0\n";
  const auto logs = parse_orientation_table(table, "t.sto");
  ASSERT_TRUE(logs) << to_string(logs.error());
  EXPECT_EQ((*logs)[1].readings[0].limb, Limb::ShankLeft);
  EXPECT_NEAR((*logs)[0].rate_hz, 100.0, 1e-6);
  const auto frames = frames_of(*logs, SensorId::parse("suit").value());
  ASSERT_TRUE(frames) << to_string(frames.error());
  ASSERT_EQ(frames->size(), 2u);
  const auto again = parse_orientation_table(write_orientation_table(*frames), "t.sto");
  ASSERT_TRUE(again) << to_string(again.error());
  for (std::size_t s = 0; s < 2; ++s)
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_LT(angular_distance(*(*again)[s].readings[i].inertial_from_sensor,
                                 *(*logs)[s].readings[i].inertial_from_sensor),
                1e-7);
  EXPECT_FALSE(parse_orientation_table("time\ta\n0\t2,0,0,0\n", "t"));
  EXPECT_FALSE(parse_orientation_table("time\ta\n0\t1,0,0\n", "t"));
  EXPECT_FALSE(parse_orientation_table("time\ta\n1\t1,0,0,0\n1\t1,0,0,0\n", "t"));
}

TEST(SensorLogs, OfOneNameAreRefused) {
  SensorLog log{"a", 100.0, {}};
  EXPECT_FALSE(frames_of({log, log}, SensorId::parse("suit").value()));
}

TEST(SlimeVr, GoesBothWaysAndRefusesDamage) {
  using namespace slimevr;
  Handshake hello;
  hello.board = 9;
  hello.firmware = "0.4.0";
  hello.mac = {1, 2, 3, 4, 5, 6};
  const auto shaken = parse(encode({0, hello}));
  ASSERT_TRUE(shaken) << to_string(shaken.error());
  EXPECT_EQ(std::get<Handshake>((*shaken)[0].content).mac, hello.mac);
  EXPECT_EQ(std::get<Handshake>((*shaken)[0].content).firmware, "0.4.0");

  const Rotation turned{2, exp_map({0.3, 0.2, -0.5})};
  const Packet rotation{77, turned};
  const std::string bytes = encode(rotation);
  const auto found = parse(bytes);
  ASSERT_TRUE(found);
  EXPECT_EQ((*found)[0].number, 77u);
  EXPECT_LT(angular_distance(std::get<Rotation>((*found)[0].content).world_from_tracker,
                             turned.world_from_tracker),
            1e-6);
  for (std::size_t size = 0; size + 1 < bytes.size(); ++size)
    EXPECT_FALSE(parse(bytes.substr(0, size))) << size;

  const auto both =
      parse(encode_bundle({rotation, {0, Acceleration{1, {1, 2, 3}}}, {0, Battery{3.9, 0.5}}}));
  ASSERT_TRUE(both) << to_string(both.error());
  ASSERT_EQ(both->size(), 3u);
  EXPECT_EQ(std::get<Acceleration>((*both)[1].content).in_tracker, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(std::get<Battery>((*both)[2].content).charge, 0.5, 1e-6);
  EXPECT_FALSE(parse(encode({1, Rotation{0, Eigen::Quaterniond(2, 0, 0, 0)}})));
  EXPECT_EQ(std::get<Other>((*parse(encode({1, Other{200}})))[0].content).type, 200u);
  EXPECT_EQ(handshake_answer().size(), 64u);
  EXPECT_EQ(handshake_answer().substr(0, 13), "\x03Hey OVR =D 5");
}

/// Bytes as @slimevr/firmware-protocol 0.6.6 writes them, the project's own package.
TEST(SlimeVr, ReadsAndWritesTheBytesOfAForeignSender) {
  using namespace slimevr;
  const char* const foreign[] = {
      "00000011000000000000000702013dcccccd3e4ccccd3e99999a3f6d679600",
      "0000000400000000000000083f800000400000004040000001",
      "0000000c00000000000000094079999a3f000000",
      "0000000f000000000000000a010104",
      "0000000300000000000000000000000900000004000000010000000000000000000000000000000d05302e342e30"
      "010203040506",
      "00000012000000000000000b013f000000"};
  std::vector<Packet> found;
  for (const std::string hex : foreign) {
    std::string bytes;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 2)
      bytes.push_back(static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16)));
    const auto packets = parse(bytes);
    ASSERT_TRUE(packets) << to_string(packets.error());
    EXPECT_EQ(encode(packets->front()), bytes) << hex;
    found.push_back(packets->front());
  }
  const auto& turned = std::get<Rotation>(found[0].content);
  EXPECT_EQ(turned.sensor, 2);
  EXPECT_NEAR(turned.world_from_tracker.z(), 0.3, 1e-6);
  EXPECT_EQ(std::get<Acceleration>(found[1].content).in_tracker, Eigen::Vector3d(1, 2, 3));
  EXPECT_NEAR(std::get<Battery>(found[2].content).volts, 3.9, 1e-6);
  EXPECT_EQ(std::get<SensorState>(found[3].content).type, 4);
  EXPECT_EQ(std::get<Handshake>(found[4].content).board, 9u);
}

}  // namespace
}  // namespace chorus::inertial
