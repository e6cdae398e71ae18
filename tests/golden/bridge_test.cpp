// Reads the golden files in proto/golden/bridge: which messages are accepted, and with what error
// the others are refused.
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/body/bones.h"
#include "services/sensor/device/bridge/push_message.h"
#include "tests/support/matchers.h"

namespace chorus::bridge {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

const std::string kFolder = "proto/golden/bridge/";

std::string text_of(const std::string& file) {
  std::ifstream in(kFolder + file);
  EXPECT_TRUE(in) << file;
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

struct Read {
  std::optional<Hello> hello;
  std::vector<PushedFrame> frames;
};

Read read_lines(const std::string& file) {
  Read read;
  std::istringstream lines(text_of(file));
  for (std::string line; std::getline(lines, line);) {
    auto message = read_push_message(line, read.hello ? &*read.hello : nullptr);
    EXPECT_THAT(message, chorus::testing::IsOk()) << line;
    if (!message) continue;
    if (auto* hello = std::get_if<Hello>(&*message)) read.hello = *hello;
    if (auto* frame = std::get_if<PushedFrame>(&*message)) read.frames.push_back(*frame);
  }
  return read;
}

constexpr std::array kTerms{"cxx", "cxy", "cxz", "cyy", "cyz", "czz"};

void expect_joint(const Joint& joint, const Json& wanted, const std::string& name) {
  const bool ray = wanted.contains("rayX");
  EXPECT_EQ(joint.measurement, ray ? Measurement::Ray : Measurement::Point) << name;
  const Eigen::Vector3d place(wanted[ray ? "rayX" : "x"], wanted[ray ? "rayY" : "y"],
                              wanted[ray ? "rayZ" : "z"]);
  EXPECT_THAT(joint.position, chorus::testing::VectorNear(place, ray ? 2e-6 : 1e-4)) << name;
  EXPECT_EQ(joint.state, wanted["state"] == "Tracked" ? JointState::Tracked : JointState::Inferred)
      << name;
  ASSERT_EQ(joint.covariance.known(), wanted.contains("cxx")) << name;
  for (std::size_t i = 0; joint.covariance.known() && i < kTerms.size(); ++i)
    EXPECT_NEAR(joint.covariance.term(i), wanted[kTerms[i]].get<double>(), 1e-8)
        << name << kTerms[i];
}

void expect_joints(const Skeleton<SensorSpace>& skeleton, const Json& wanted) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const std::string name(kJointNames[i]);
    if (wanted.contains(name)) {
      expect_joint(skeleton.joints[i], wanted[name], name);
    } else {
      EXPECT_EQ(skeleton.joints[i].state, JointState::NotTracked) << name;
    }
  }
}

void expect_body(const PushedFrame& frame, std::size_t index, const Json& wanted) {
  const Json& id = wanted["bodyId"];
  EXPECT_EQ(std::to_string(frame.bodies[index].id.value),
            id.is_string() ? id.get<std::string>() : id.dump());
  expect_joints(frame.bodies[index].skeleton, wanted["joints"]);
  expect_joints(frame.shapes.at(index), wanted.value("shape", Json::object()));
}

class Golden : public ::testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Bridge, Golden, ::testing::Values("points", "pixels", "world"),
                         [](const auto& row) { return std::string(row.param); });

TEST_P(Golden, MessagesMeanTheirFrames) {
  const std::string name = GetParam();
  const Read read = read_lines(name + ".jsonl");
  const Json wanted = Json::parse(text_of(name + ".json"));
  ASSERT_EQ(read.frames.size(), wanted["frames"].size());
  for (std::size_t i = 0; i < read.frames.size(); ++i) {
    const Json& frame = wanted["frames"][i];
    EXPECT_EQ(std::to_string(to_unix_ns(read.frames[i].captured)), frame["capturedNanoseconds"]);
    ASSERT_EQ(read.frames[i].bodies.size(), frame["bodies"].size());
    for (std::size_t b = 0; b < frame["bodies"].size(); ++b)
      expect_body(read.frames[i], b, frame["bodies"][b]);
  }
}

TEST(GoldenHello, FloorIsBroughtIntoSensorSpace) {
  const Read read = read_lines("points.jsonl");
  const Json floor = Json::parse(text_of("points.json"))["floor"];
  ASSERT_TRUE(read.hello && read.hello->floor);
  const Eigen::Vector3d normal(floor["normalX"], floor["normalY"], floor["normalZ"]);
  EXPECT_THAT(read.hello->floor->normal, chorus::testing::VectorNear(normal, 1e-4));
  EXPECT_NEAR(read.hello->floor->offset, floor["offset"].get<double>(), 1e-9);
}

TEST(GoldenMistakes, AreRefusedWithTheirPlaceAndWhatToChange) {
  const auto hello =
      read_push_message(R"({"type":"hello","name":"golden","layout":"coco_17"})", nullptr);
  ASSERT_THAT(hello, chorus::testing::IsOk());
  const Json all = Json::parse(text_of("refused.json"));
  ASSERT_GT(all.size(), 20U);
  for (const Json& one : all) {
    const std::string line = one["line"].dump();
    const auto read = read_push_message(line, &std::get<Hello>(*hello));
    ASSERT_FALSE(read) << line;
    EXPECT_EQ(read.error().context, one["context"]) << line;
    EXPECT_THAT(read.error().message, HasSubstr(one["says"].get<std::string>())) << line;
  }
}

TEST(GoldenSchema, NamesOurLayouts) {
  std::ifstream in("proto/bridge.schema.json");
  const Json names = Json::parse(in)["$defs"]["Hello"]["properties"]["layout"]["enum"];
  std::set<std::string> ours;
  for (const layout::Layout* layout : layout::layouts()) ours.emplace(layout->name);
  EXPECT_EQ(names.get<std::set<std::string>>(), ours);
}

}  // namespace
}  // namespace chorus::bridge
