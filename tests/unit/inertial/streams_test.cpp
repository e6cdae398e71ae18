// Streams of makers' programs: what they say, and what is refused by name.
#include <bit>
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lz4frame.h>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/inertial/mocopi.h"
#include "common/inertial/neuron_bvh.h"
#include "common/inertial/osc_message.h"
#include "common/inertial/rokoko.h"
#include "common/inertial/vmc.h"
#include "tests/support/builders.h"
#include "tests/support/matchers.h"

namespace chorus::inertial {
namespace {

using chorus::testing::IsOk;
using ::testing::HasSubstr;

constexpr Timestamp kHeard = chorus::testing::kStart;
constexpr double kSent = 1e-6;  // of single precision [rad]

Eigen::Quaterniond turn_about(const Eigen::Vector3d& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(deg(degrees), axis));
}
const Eigen::Vector3d kX = Eigen::Vector3d::UnitX();
const Eigen::Vector3d kY = Eigen::Vector3d::UnitY();
const Eigen::Vector3d kZ = Eigen::Vector3d::UnitZ();

using Heard = std::map<Limb, InertialReading>;

Heard heard(StreamReader& reader) {
  Heard out;
  const auto frame = reader.instant(kHeard);
  if (!frame) return out;
  EXPECT_THAT(checked(*frame), IsOk());
  for (const InertialReading& each : frame->readings)
    if (each.limb) out[*each.limb] = each;
  return out;
}

double off(const Heard& all, Limb limb, const Eigen::Quaterniond& expected) {
  const auto found = all.find(limb);
  if (found == all.end() || !found->second.inertial_from_sensor) return 1e9;
  return angular_distance(*found->second.inertial_from_sensor, expected);
}

std::string why(const Result<void>& result) {
  return result ? std::string("was taken") : to_string(result.error());
}

// --- mocopi, bytes written by hand from the layout.

std::string box(const std::string& name, const std::string& content) {
  std::string out;
  for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(content.size() >> (8 * i) & 0xff));
  return out + name + content;
}
std::string word(std::uint64_t value, int bytes) {
  std::string out;
  for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(value >> (8 * i) & 0xff));
  return out;
}
std::string transform(const Eigen::Quaterniond& q) {
  std::string out;
  for (const double each : {q.x(), q.y(), q.z(), q.w(), 0.1, 0.2, 0.3})
    out += word(std::bit_cast<std::uint32_t>(static_cast<float>(each)), 4);
  return out;
}
std::string mocopi_head() {
  return box("head", box("ftyp", "sony motion format") + box("vrsn", "\1")) +
         box("sndf", box("ipad", word(1, 8)) + box("rcvp", word(12351, 2)));
}
std::string mocopi_frame(std::uint32_t number, const std::map<int, Eigen::Quaterniond>& bones) {
  std::string all;
  for (const auto& [id, q] : bones)
    all += box("btdt", box("bnid", word(static_cast<unsigned>(id), 2)) + box("tran", transform(q)));
  return mocopi_head() + box("fram", box("fnum", word(number, 4)) + box("time", word(0, 4)) +
                                         box("uttm", word(0, 8)) + box("btrs", all));
}

TEST(Mocopi, MultipliesRotationsAlongTheChain) {
  const auto reader = make_mocopi_reader();
  const Eigen::Quaterniond hip = turn_about(kY, 90), knee = turn_about(kX, 30);
  // A quaternion and its negative are the same rotation; the app sends w = -1.
  const Eigen::Quaterniond negative(Eigen::Vector4d(-knee.coeffs()));
  ASSERT_THAT(reader->take(mocopi_frame(1, {{0, hip}, {20, negative}}), kHeard), IsOk());
  const Heard all = heard(*reader);
  EXPECT_EQ(all.size(), 2u);
  EXPECT_LT(off(all, Limb::Pelvis, hip), kSent);
  EXPECT_LT(off(all, Limb::ShankLeft, hip * knee), kSent);
  EXPECT_EQ(all.at(Limb::ShankLeft).sensor, "l_low_leg");
  EXPECT_FALSE(reader->instant(kHeard)) << "nothing new";
}

TEST(Mocopi, TakesTheSkeletonsParents) {
  const auto reader = make_mocopi_reader();
  const std::string bone = box("bndt", box("bnid", word(13, 2)) + box("pbid", word(0, 2)) +
                                           box("tran", transform(turn_about(kX, 0))));
  ASSERT_THAT(reader->take(mocopi_head() + box("skdf", box("bons", bone)), kHeard), IsOk());
  EXPECT_FALSE(reader->instant(kHeard)) << "a skeleton is no instant";
  const Eigen::Quaterniond hip = turn_about(kY, 40), arm = turn_about(kZ, 20);
  ASSERT_THAT(
      reader->take(mocopi_frame(1, {{0, hip}, {12, turn_about(kX, 80)}, {13, arm}}), kHeard),
      IsOk());
  EXPECT_LT(off(heard(*reader), Limb::ForearmLeft, hip * arm), kSent);
}

TEST(Mocopi, RefusesByName) {
  const auto reader = make_mocopi_reader();
  const auto refused = [&](const std::string& bytes) { return why(reader->take(bytes, kHeard)); };
  const std::string good = mocopi_frame(7, {{0, turn_about(kX, 1)}});
  EXPECT_THAT(refused(good.substr(0, good.size() - 3)), HasSubstr("too early"));
  EXPECT_THAT(refused("hello"), HasSubstr("too early"));
  EXPECT_THAT(refused(box("head", box("ftyp", "another format"))), HasSubstr("another format"));
  EXPECT_THAT(refused(mocopi_frame(7, {{0, Eigen::Quaterniond(0, 0, 0, 0)}})), HasSubstr("bone 0"));
  EXPECT_THAT(refused(mocopi_frame(7, {{0, Eigen::Quaterniond(NAN, 0, 0, 1)}})),
              HasSubstr("bone 0"));
  EXPECT_THAT(refused(mocopi_frame(7, {{40, turn_about(kX, 1)}})), HasSubstr("bone 40"));
  const std::string loop = box("bndt", box("bnid", word(3, 2)) + box("pbid", word(5, 2)) +
                                           box("tran", transform(turn_about(kX, 0))));
  EXPECT_THAT(refused(mocopi_head() + box("skdf", box("bons", loop))), HasSubstr("parent"));
  EXPECT_THAT(reader->take(good, kHeard), IsOk()) << "and goes on";
  EXPECT_THAT(refused(good), HasSubstr("not newer"));
  EXPECT_THAT(reader->take(mocopi_frame(2'000'000'000, {}), kHeard), IsOk());
}

TEST(Mocopi, ReadsWhatItWrites) {
  mocopi::Packet packet;
  packet.number = 99;
  packet.bones = {{0, -1, turn_about(kY, 10)}, {5, -1, turn_about(kX, 70)}};
  const auto again = mocopi::parse(mocopi::encode(packet));
  ASSERT_THAT(again, IsOk());
  EXPECT_EQ(again->number, 99u);
  ASSERT_EQ(again->bones.size(), 2u);
  EXPECT_LT(angular_distance(again->bones[1].in_parent, packet.bones[1].in_parent), kSent);
}

// --- OSC, VMC and VRChat; the round trip with our own output is in tests/unit/osc.

std::string osc_text(std::string text) {
  text.resize(text.size() + 4 - text.size() % 4, '\0');
  return text;
}
std::string osc_real(double value) {
  const std::string little = word(std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
  return {little.rbegin(), little.rend()};
}
std::string vmc_bone(const std::string& address, const std::string& name,
                     const std::vector<double>& numbers) {
  std::string out =
      osc_text(address) + osc_text(",s" + std::string(numbers.size(), 'f')) + osc_text(name);
  for (const double each : numbers) out += osc_real(each);
  return out;
}

TEST(Osc, ReadsNumbersTextsAndBundlesInBundles) {
  const std::string one = vmc_bone("/a", "word", {1.5, -2});
  const std::string size = std::string(3, '\0') + static_cast<char>(one.size());
  const std::string bundle = std::string("#bundle\0", 8) + std::string(8, '\0') + size + one;
  const std::string outer_size = std::string(3, '\0') + static_cast<char>(bundle.size());
  const std::string outer =
      std::string("#bundle\0", 8) + std::string(8, '\0') + outer_size + bundle;
  const auto messages = parse_osc(outer);
  ASSERT_THAT(messages, IsOk());
  ASSERT_EQ(messages->size(), 1u);
  EXPECT_EQ(messages->front().address, "/a");
  EXPECT_EQ(messages->front().texts.at(0), "word");
  EXPECT_EQ(messages->front().numbers, (std::vector<double>{1.5, -2}));
  for (std::size_t cut = 1; cut < outer.size(); ++cut) {
    if (cut == 16) continue;  // An empty bundle is whole.
    EXPECT_FALSE(parse_osc(outer.substr(0, cut))) << cut;
  }
}

TEST(Vmc, RefusesByNameAndLeavesOutWhatNobodyWears) {
  const auto reader = make_vmc_reader();
  const std::string bone = "/VMC/Ext/Bone/Pos";
  EXPECT_THAT(why(reader->take(vmc_bone(bone, "LeftHand", {0, 0, 0, 0, 0, 0, 3}), kHeard)),
              HasSubstr("LeftHand"));
  EXPECT_THAT(why(reader->take(vmc_bone(bone, "Hips", {0, 0, 0}), kHeard)), HasSubstr("seven"));
  EXPECT_THAT(why(reader->take("no osc at all", kHeard)), HasSubstr("OSC"));
  EXPECT_THAT(reader->take(vmc_bone(bone, "LeftIndexDistal", {0, 0, 0, 0, 0, 0, 3}), kHeard),
              IsOk());
  EXPECT_THAT(reader->take(vmc_bone("/VMC/Ext/Blend/Val", "Joy", {1}), kHeard), IsOk());
  EXPECT_FALSE(reader->instant(kHeard));
}

TEST(Vmc, TrackersAreSensorsOfUnknownLimbs) {
  const auto reader = make_vmc_reader();
  ASSERT_THAT(reader->take(vmc_bone("/VMC/Ext/Tra/Pos", "LHR-1", {1, 2, 3, 0, 0, 0, 1}), kHeard),
              IsOk());
  const auto frame = reader->instant(kHeard);
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->readings.at(0).sensor, "Tra/LHR-1");
  EXPECT_FALSE(frame->readings.at(0).limb);
}

TEST(Vrchat, RefusesByName) {
  const auto reader = make_vrchat_reader();
  const auto message = [](const std::string& which, double x) {
    return osc_text("/tracking/trackers/" + which + "/rotation") + osc_text(",fff") + osc_real(x) +
           osc_real(0) + osc_real(0);
  };
  EXPECT_THAT(why(reader->take(message("9", 0), kHeard)), HasSubstr("VRChat tracker 9"));
  EXPECT_THAT(why(reader->take(message("1", NAN), kHeard)), HasSubstr("three angles"));
  ASSERT_THAT(reader->take(message("1", 30), kHeard), IsOk());
  // Unity is left-handed: a positive turn about x is a negative one here.
  EXPECT_LT(off(heard(*reader), Limb::Pelvis, turn_about(kX, -30)), 1e-5);
}

// --- Rokoko

const char* const kActorV3 =
    R"({"version":"3,0","fps":60,"scene":{"timestamp":1.5,"actors":[{"name":"Anna","body":{
      "hip":{"position":{"x":0,"y":1,"z":0},"rotation":{"x":0,"y":0.7071068,"z":0,"w":0.7071068}},
      "leftLowerArm":{"position":{"x":0,"y":1,"z":0},"rotation":{"x":0,"y":0,"z":0.5,"w":0.8660254}}}},
      {"name":"Bo","body":{"hip":{"rotation":{"x":0,"y":0,"z":0,"w":1}}}}],"props":[]}})";

TEST(Rokoko, ReadsVersion3InUnitysAxes) {
  const auto reader = make_rokoko_reader("");
  ASSERT_THAT(reader->take(kActorV3, kHeard), IsOk());
  const Heard all = heard(*reader);
  EXPECT_EQ(all.size(), 2u);
  EXPECT_LT(off(all, Limb::Pelvis, turn_about(kY, -90)), kSent);
  EXPECT_LT(off(all, Limb::ForearmLeft, turn_about(kZ, 60)), kSent);
  EXPECT_EQ(all.at(Limb::ForearmLeft).sensor, "leftLowerArm");
}

TEST(Rokoko, TakesTheActorThatIsNamed) {
  const auto reader = make_rokoko_reader("Bo");
  ASSERT_THAT(reader->take(kActorV3, kHeard), IsOk());
  EXPECT_LT(off(heard(*reader), Limb::Pelvis, turn_about(kY, 0)), kSent);
  EXPECT_THAT(why(make_rokoko_reader("Cy")->take(kActorV3, kHeard)), HasSubstr("\"Cy\""));
}

TEST(Rokoko, ReadsVersion2AndStudiosTwoAndAHalf) {
  for (const std::string version : {"2", "\"3.0\""}) {
    const auto reader = make_rokoko_reader("");
    const std::string text = R"({"version":)" + version +
                             R"(,"timestamp":1,"trackers":[],"actors":[{"name":"A","leftForearm":
                               {"position":{},"rotation":{"x":0,"y":0,"z":0.5,"w":0.8660254}}}]})";
    ASSERT_THAT(reader->take(text, kHeard), IsOk()) << version;
    EXPECT_LT(off(heard(*reader), Limb::ForearmLeft, turn_about(kZ, 60)), kSent);
  }
}

std::string packed_by_lz4(const std::string& text) {
  std::string out(LZ4F_compressFrameBound(text.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), text.data(), text.size(), nullptr));
  return out;
}

TEST(Rokoko, ReadsWhatIsPackedByLz4) {
  const auto reader = make_rokoko_reader("Bo");
  const std::string packed = packed_by_lz4(std::string(kActorV3));
  ASSERT_THAT(reader->take(packed, kHeard), IsOk());
  EXPECT_LT(off(heard(*reader), Limb::Pelvis, turn_about(kY, 0)), kSent);
  for (std::size_t length = 4; length < packed.size(); ++length)
    EXPECT_FALSE(reader->take(packed.substr(0, length), kHeard)) << length;
  EXPECT_THAT(why(reader->take(packed_by_lz4(std::string(8U << 20, ' ')), kHeard)),
              HasSubstr("more than"));
  EXPECT_THAT(why(reader->take(packed_by_lz4("no JSON at all"), kHeard)), HasSubstr("no JSON"));
}

TEST(Rokoko, RefusesByNameWithWhatToChange) {
  const auto reader = make_rokoko_reader("");
  const auto refused = [&](const std::string& text) { return why(reader->take(text, kHeard)); };
  EXPECT_THAT(refused("\x04\x22\x4d\x18zzzz"), HasSubstr("LZ4"));
  EXPECT_THAT(refused("{"), HasSubstr("no JSON"));
  EXPECT_THAT(refused("[1,2]"), HasSubstr("version"));
  EXPECT_THAT(refused(R"({"version":1,"actors":[]})"), HasSubstr("version"));
  EXPECT_THAT(refused(R"({"version":3,"scene":{"actors":[]}})"), HasSubstr("actor"));
  const std::string before = R"({"version":3,"scene":{"actors":[{"name":"a","body":{"hip":)";
  EXPECT_THAT(refused(before + R"({"rotation":{"x":0,"y":0,"z":0,"w":9}}}}]}})"), HasSubstr("hip"));
  EXPECT_THAT(refused(before + R"({"rotation":{"x":0,"y":"0","z":0,"w":1}}}}]}})"),
              HasSubstr("hip"));
  EXPECT_THAT(refused(before + R"({}}}]}})"), HasSubstr("hip"));
  EXPECT_THAT(refused(std::string(70'000, ' ')), HasSubstr("longer"));
}

// --- Perception Neuron

std::string neuron_frame(bool displacement, const std::map<int, Eigen::Vector3d>& turned) {
  std::string out = "0 char00";
  for (int bone = 0; bone < 59; ++bone) {
    if (displacement || bone == 0) out += " 1.0 2.0 3.0";
    const auto found = turned.find(bone);
    const Eigen::Vector3d angles = found == turned.end() ? Eigen::Vector3d::Zero() : found->second;
    for (int i = 0; i < 3; ++i) out += " " + std::to_string(angles[i]);
  }
  return out + " ||\n";
}

TEST(NeuronBvh, ReadsBothFormsCutAnywhere) {
  // Hips by 90 about y, the left forearm by 30 about x, in the order y x z.
  const std::map<int, Eigen::Vector3d> turned{{0, {90, 0, 0}}, {38, {0, 30, 0}}};
  for (const bool displacement : {true, false}) {
    const std::string text = neuron_frame(displacement, turned);
    for (const std::size_t cut : {std::size_t{1}, text.size() / 2, text.size() - 2}) {
      const auto reader = make_neuron_reader();
      ASSERT_THAT(reader->take(text.substr(0, cut), kHeard), IsOk());
      EXPECT_FALSE(reader->instant(kHeard));
      ASSERT_THAT(reader->take(text.substr(cut), kHeard), IsOk());
      const Heard all = heard(*reader);
      EXPECT_EQ(all.size(), 15u);
      EXPECT_LT(off(all, Limb::ForearmLeft, turn_about(kY, 90) * turn_about(kX, 30)), kSent);
      EXPECT_LT(off(all, Limb::ForearmRight, turn_about(kY, 90)), kSent);
    }
  }
}

TEST(Streams, LoseNothingWhenTheyAreFasterThanTheyAreAsked) {
  using std::chrono::milliseconds;
  const auto reader = make_neuron_reader();
  for (int i = 1; i <= 10; ++i)
    ASSERT_THAT(reader->take(neuron_frame(false, {{0, {1.0 * i, 0, 0}}}), kHeard + milliseconds(i)),
                IsOk());
  for (int i = 1; i <= 10; ++i) {
    const auto one = reader->instant(kHeard + milliseconds(11));
    ASSERT_TRUE(one) << i;
    EXPECT_EQ(one->sequence, static_cast<std::uint64_t>(i));
    EXPECT_EQ(one->captured, kHeard + milliseconds(i == 10 ? 11 : i));
    EXPECT_LT(angular_distance(*one->readings[0].inertial_from_sensor, turn_about(kY, i)), kSent);
  }
  EXPECT_FALSE(reader->instant(kHeard + milliseconds(12)));
  for (int i = 0; i < 500; ++i)
    (void)reader->take(neuron_frame(false, {}), kHeard + milliseconds(20 + i));
  int kept = 0;
  while (reader->instant(kHeard + milliseconds(600))) ++kept;
  EXPECT_EQ(kept, 101) << "of a flood the newest";
  (void)reader->take(neuron_frame(false, {}) + neuron_frame(false, {}), kHeard);
  EXPECT_TRUE(reader->instant(kHeard));
  EXPECT_FALSE(reader->instant(kHeard)) << "two of one time are one";
}

TEST(NeuronBvh, TakesItsOwnAvatarAndRefusesByName) {
  const auto other = make_neuron_reader(1);
  ASSERT_THAT(other->take(neuron_frame(true, {}), kHeard), IsOk());
  EXPECT_FALSE(other->instant(kHeard));
  const auto reader = make_neuron_reader();
  EXPECT_THAT(why(reader->take("0 char00 1 2 3 ||", kHeard)), HasSubstr("3 numbers"));
  std::string bad = neuron_frame(false, {});
  bad.replace(bad.find("0.000000"), 8, "zero    ");
  EXPECT_THAT(why(reader->take(bad, kHeard)), HasSubstr("Hips"));
  EXPECT_THAT(why(reader->take(std::string(20'000, 'x'), kHeard)), HasSubstr("16 kB"));
  EXPECT_THAT(reader->take(neuron_frame(false, {}), kHeard), IsOk()) << "and goes on";
  EXPECT_TRUE(reader->instant(kHeard));
  (void)reader->take("half a frame", kHeard);
  reader->restart();
  EXPECT_THAT(reader->take(neuron_frame(false, {}), kHeard), IsOk()) << "a new connection";
}

}  // namespace
}  // namespace chorus::inertial
