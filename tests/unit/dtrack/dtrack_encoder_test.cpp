// DTrack's lines, read by a parser written from the format's description.
#include "fusion-server/dtrack/dtrack_encoder.h"

#include <charconv>
#include <clocale>
#include <map>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/matchers.h"
#include "tests/unit/outlet/rig_poses.h"

namespace chorus::dtrack {
namespace {

using chorus::testing::VectorNear;
using outlet::testing::about_up;
using outlet::testing::about_x;
using outlet::testing::about_z;

/// Name of a line -> the rest of it.  Every line must end with CR LF.
std::map<std::string, std::string> lines_of(const std::string& datagram) {
  std::map<std::string, std::string> lines;
  std::string rest = datagram;
  while (!rest.empty()) {
    const std::size_t end = rest.find("\r\n");
    if (end == std::string::npos) {
      ADD_FAILURE() << "no CR LF after " << rest;
      break;
    }
    const std::string line = rest.substr(0, end);
    const std::size_t space = line.find(' ');
    EXPECT_FALSE(lines.contains(line.substr(0, space))) << line;
    lines[line.substr(0, space)] = line.substr(space + 1);
    rest.erase(0, end + 2);
  }
  return lines;
}

/// The numbers in each [block] of a line; those before the first block come first.
std::vector<std::vector<double>> blocks_of(std::string line) {
  std::vector<std::vector<double>> blocks;
  for (char& c : line) {
    if (c == '[') c = '|';
    if (c == ']') c = ' ';
  }
  std::stringstream parts(line);
  for (std::string part; std::getline(parts, part, '|');) {
    std::stringstream numbers(part);
    numbers.imbue(std::locale::classic());
    std::vector<double> block;
    for (double number = 0; numbers >> number;) block.push_back(number);
    EXPECT_TRUE(numbers.eof()) << part;
    blocks.push_back(block);
  }
  return blocks;
}

struct Body {
  Eigen::Vector3d place, angles;
  Eigen::Matrix3d rotation;  ///< b0 b1 b2 are the first column.
};

Body body_of(const std::vector<double>& pose, const std::vector<double>& b) {
  Body body;
  body.place = {pose.at(0), pose.at(1), pose.at(2)};
  body.angles = {pose.at(3), pose.at(4), pose.at(5)};
  body.rotation << b.at(0), b.at(3), b.at(6), b.at(1), b.at(4), b.at(7), b.at(2), b.at(5), b.at(8);
  return body;
}

std::map<int, Body> bodies_of(const std::string& line) {
  const auto blocks = blocks_of(line);
  std::map<int, Body> bodies;
  EXPECT_EQ(blocks.at(0).at(0) * 3 + 1, static_cast<double>(blocks.size()));
  for (std::size_t i = 1; i + 2 < blocks.size() + 0; i += 3) {
    EXPECT_EQ(blocks[i].at(1), 1.0);
    bodies[static_cast<int>(blocks[i].at(0))] = body_of(blocks[i + 1], blocks[i + 2]);
  }
  return bodies;
}

outlet::TrackerFrame frame_with(const outlet::TrackerBody& body, std::size_t slot = 0) {
  outlet::TrackerFrame frame;
  frame.sequence = 0x1'0000'0009;
  frame.instant = from_unix_ns(1'795'246'604'001'847'341);  // 07:36:44.001847 UTC
  frame.slots = 6;
  frame.bodies = {body};
  frame.bodies[0].slot = slot;
  return frame;
}

outlet::TrackerBody one_joint() {
  outlet::TrackerBody body;
  outlet::TrackerJoint& head = body.joints[index_of(JointId::Head)];
  head.position = {1, 2, 3};
  head.orientation = about_x(20) * about_up(30) * about_z(-50);
  head.tracked = true;
  return body;
}

TEST(Dtrack, LinesSayWhichFrameWhenAndHowMany) {
  const auto lines =
      lines_of(encode(frame_with(one_joint()), {.latency = std::chrono::microseconds(2345)}));
  EXPECT_EQ(lines.at("fr"), "9");
  EXPECT_EQ(lines.at("ts"), "27404.001847");
  EXPECT_EQ(lines.at("ts2"), "1795246604 1847 2345");
  EXPECT_EQ(lines.at("6dcal"), "150");
  EXPECT_EQ(lines.at("3d"), "0");
  EXPECT_EQ(lines.size(), 6u);
}

TEST(Dtrack, AnAsymmetricPoseIsInMillimetresZUpAndColumnByColumn) {
  const auto lines = lines_of(encode(frame_with(one_joint(), 1)));
  const auto bodies = bodies_of(lines.at("6d"));
  ASSERT_EQ(bodies.size(), 1u);
  const Body& body = bodies.at(25 + 3);
  EXPECT_THAT(body.place, VectorNear(Eigen::Vector3d(1000, -3000, 2000), 1e-3));
  // Our y is the room's z, and our z is its -y.
  const Eigen::Quaterniond expected = about_x(20) * about_z(30) * about_up(50);
  EXPECT_LT((body.rotation - expected.toRotationMatrix()).norm(), 5e-6);
  const Eigen::Quaterniond turned =
      about_x(body.angles.x()) * about_up(body.angles.y()) * about_z(body.angles.z());
  EXPECT_LT((body.rotation - turned.toRotationMatrix()).norm(), 1e-5);
}

TEST(Dtrack, APowerwallRoomIsYUp) {
  const auto lines = lines_of(encode(frame_with(one_joint()), {{}, false, Room::Powerwall}));
  const Body body = bodies_of(lines.at("6d")).at(3);
  EXPECT_THAT(body.place, VectorNear(Eigen::Vector3d(1000, 2000, 3000), 1e-3));
  const Eigen::Quaterniond expected = about_x(20) * about_up(30) * about_z(-50);
  EXPECT_LT((body.rotation - expected.toRotationMatrix()).norm(), 5e-6);
  EXPECT_THAT(body.angles, VectorNear(Eigen::Vector3d(20, 30, -50), 1e-3));
}

TEST(Dtrack, BodiesAreWrittenAsCapturesShow) {
  outlet::TrackerBody body = one_joint();
  body.joints[index_of(JointId::Head)].orientation.setIdentity();
  body.joints[index_of(JointId::Head)].position = {0.0001, 1.5, -0.25};
  EXPECT_EQ(lines_of(encode(frame_with(body))).at("6d"),
            "1 [3 1.000][0.100 250.000 1500.000 0.0000 0.0000 0.0000]"
            "[1.000000 0.000000 0.000000 0.000000 1.000000 0.000000 0.000000 0.000000 1.000000]");
}

TEST(Dtrack, OurParserReadsTheRealCapturesWeKnow) {
  // A line of a genuine datagram: if it could not be read, the tests above would mean nothing.
  const auto bodies = bodies_of(
      "1 [0 1.000][-475.292 -567.632 -53.704 135.5743 5.7618 -3.3069][0.993291 0.111352 0.031199 "
      "0.057393 -0.708916 0.702954 0.100393 -0.696447 -0.710551]");
  const Body& body = bodies.at(0);
  const Eigen::Quaterniond turned =
      about_x(body.angles.x()) * about_up(body.angles.y()) * about_z(body.angles.z());
  EXPECT_LT((body.rotation - turned.toRotationMatrix()).norm(), 1e-5);
}

TEST(Dtrack, NobodyIsSaidToo) {
  outlet::TrackerFrame frame = frame_with({});
  frame.bodies.clear();
  const auto lines = lines_of(encode(frame, {Duration{-5}, true, Room::Normal}));
  EXPECT_EQ(lines.at("6d"), "0");
  EXPECT_EQ(lines.at("6dj"), "6 0");
  EXPECT_EQ(lines.at("ts2"), "1795246604 1847 0");  // latency is never negative
}

TEST(Dtrack, UntrackedJointsAreLeftOut) {
  outlet::TrackerBody body = outlet::testing::t_pose();
  body.joints[index_of(JointId::Neck)].tracked = false;
  body.joints[index_of(JointId::Neck)].position.setConstant(std::nan(""));
  const std::string datagram = encode(frame_with(body), {.human_model = true});
  const auto bodies = bodies_of(lines_of(datagram).at("6d"));
  EXPECT_EQ(bodies.size(), 24u);
  EXPECT_FALSE(bodies.contains(2));
  EXPECT_EQ(datagram.find("nan"), std::string::npos);
}

TEST(Dtrack, HumanModelsHaveArtsJointNumbersAndTheRigsRotations) {
  outlet::TrackerBody body = outlet::testing::t_pose();
  outlet::testing::move(body, {0, 0, 0}, -6);
  const auto lines = lines_of(encode(frame_with(body, 2), {.human_model = true}));
  const auto blocks = blocks_of(lines.at("6dj"));
  EXPECT_EQ(blocks.at(0), (std::vector<double>{6, 1}));
  EXPECT_EQ(blocks.at(1), (std::vector<double>{2, 20}));
  ASSERT_EQ(blocks.size(), 2u + 3u * 20u);
  std::map<int, Body> joints;
  for (std::size_t i = 2; i < blocks.size(); i += 3) {
    joints[static_cast<int>(blocks[i].at(0))] = body_of(blocks[i + 1], blocks[i + 2]);
  }
  EXPECT_FALSE(joints.contains(2));
  EXPECT_NEAR(joints.at(0).place.z(), 950, 1e-3);                       // pelvis
  EXPECT_NEAR(joints.at(10).place.x(), -710 * std::cos(deg(6)), 1e-2);  // left hand, at the wrist
  EXPECT_LT((joints.at(8).rotation - about_z(-6).toRotationMatrix()).norm(), 1e-5);
}

TEST(Dtrack, TheLargestDatagramFitsTheClientsBuffer) {
  for (const bool human_model : {false, true}) {
    outlet::TrackerFrame frame = frame_with(outlet::testing::asymmetric_pose());
    frame.slots = 20;
    frame.bodies.assign(20, frame.bodies[0]);
    for (std::size_t slot = 0; slot < 20; ++slot) {
      frame.bodies[slot].slot = slot;
      for (outlet::TrackerJoint& joint : frame.bodies[slot].joints) {
        joint.position = {-9999.9999, -9999.9999, 9999.9999};
        joint.position += Eigen::Vector3d::Random() * 1e-4;
      }
    }
    const std::string datagram = encode(frame, {std::chrono::hours(24), human_model, Room::Normal});
    EXPECT_LE(datagram.size(), kMaxBytes);
    const auto bodies = bodies_of(lines_of(datagram).at("6d"));
    EXPECT_EQ(bodies.size(), 150u);
    EXPECT_EQ(bodies.rbegin()->first, 149);
    EXPECT_EQ(lines_of(datagram).at("6dcal"), "150");
  }
}

TEST(Dtrack, DecimalPointsDoNotDependOnTheLocale) {
  const std::string before = encode(frame_with(one_joint()));
  const char* german = std::setlocale(LC_ALL, "de_DE.UTF-8");
  const std::string after = encode(frame_with(one_joint()));
  std::setlocale(LC_ALL, "C");
  if (german == nullptr) GTEST_SKIP() << "runs where a German locale is installed";
  EXPECT_EQ(before, after);
}

TEST(Dtrack, ThingsInHandsAreBodiesBehindThoseOfAllSlots) {
  outlet::TrackerFrame frame = frame_with(one_joint());
  frame.slots = 2;
  frame.props = {{"box", 0, {}}, {"driver", 0, {}}};
  frame.props[1].pose.position = {1, 2, 3};
  frame.props[1].pose.tracked = true;
  const auto lines = lines_of(encode(frame));
  EXPECT_EQ(lines.at("6dcal"), "52");
  const auto bodies = bodies_of(lines.at("6d"));
  ASSERT_EQ(bodies.size(), 2u);
  EXPECT_THAT(bodies.at(51).place, VectorNear(Eigen::Vector3d(1000, -3000, 2000), 1e-3));
}

}  // namespace
}  // namespace chorus::dtrack
