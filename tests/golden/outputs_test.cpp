// Every encoder of an output produces the bytes that are stored in tests/golden/outputs.
#include <bit>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "common/resource/frame_resource.h"
#include "fusion-server/dtrack/dtrack_encoder.h"
#include "fusion-server/mxtp/mxtp_encoder.h"
#include "fusion-server/natnet/natnet_encoder.h"
#include "fusion-server/natnet/natnet_messages.h"
#include "fusion-server/osc/vmc_encoder.h"
#include "fusion-server/osc/vrchat_encoder.h"
#include "fusion-server/trackd/trackd_encoder.h"

namespace chorus::outputs {
namespace {

std::string contents(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

outlet::TrackerFrame golden_frame() {
  const auto frame =
      resource::read_frame(contents("proto/golden/perfect/fused.json"), resource::Format::Json);
  EXPECT_TRUE(frame) << to_string(frame.error());
  Snapshot snapshot;
  snapshot.sequence = frame->sequence;
  snapshot.instant = frame->captured;
  for (const resource::BodyResource& body : frame->bodies) {
    FusedBody& fused = snapshot.bodies.emplace_back();
    fused.id = {body.id};
    fused.slot = body.slot;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const resource::JointResource& joint = body.joints[i];
      fused.skeleton.joints[i] = {joint.position, joint.orientation, joint.state};
    }
  }
  outlet::TrackerState state(6);
  return state.advance(snapshot);
}

void expect_golden(const std::string& name, const std::string& bytes) {
  const std::string path = "tests/golden/outputs/" + name;
  if (std::getenv("CHORUS_WRITE_GOLDEN") != nullptr) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  const std::string expected = contents(path);
  ASSERT_EQ(bytes.size(), expected.size()) << name;
  const auto first = std::mismatch(bytes.begin(), bytes.end(), expected.begin()).first;
  EXPECT_EQ(first - bytes.begin(), bytes.end() - bytes.begin()) << name << ": first difference";
}

std::string with_sizes(const std::vector<std::vector<char>>& datagrams) {
  std::string all;
  for (const auto& datagram : datagrams) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      all += static_cast<char>(datagram.size() >> shift & 0xFF);
    }
    all.append(datagram.begin(), datagram.end());
  }
  return all;
}

TEST(GoldenOutputs, Dtrack) {
  expect_golden("fused.dtrack", dtrack::encode(golden_frame(), {std::chrono::microseconds(2345),
                                                                true, dtrack::Room::Normal}));
}

TEST(GoldenOutputs, Vmc) {
  const outlet::TrackerFrame frame = golden_frame();
  expect_golden("fused.vmc", with_sizes(vmc::encode(outlet::in_slot(frame, 0), {12.5, true})));
}

TEST(GoldenOutputs, VrChat) {
  expect_golden("fused.vrchat", with_sizes(vrchat::encode(golden_frame().bodies.at(1))));
}

TEST(GoldenOutputs, Mxtp) {
  const outlet::TrackerFrame frame = golden_frame();
  std::vector<std::vector<char>> datagrams;
  for (const outlet::TrackerBody& body : frame.bodies)
    datagrams.push_back(mxtp::encode(frame, body));
  expect_golden("fused.mxtp", with_sizes(datagrams));
}

TEST(GoldenOutputs, Trackd) {
  if (std::endian::native != std::endian::little)
    GTEST_SKIP() << "runs on little-endian machines: the block is in native order";
  auto block = trackd::tracker_block(50);
  const outlet::TrackerFrame frame = golden_frame();
  trackd::write_sensors(frame, trackd::LengthUnit::Feet, block);
  trackd::write_stamp(frame.instant, block);
  expect_golden("fused.trackd", {block.begin(), block.end()});
}

/// The file holds the server's information, the model definitions of two slots, and a frame.
TEST(GoldenOutputs, NatNet) {
  const outlet::TrackerFrame frame = golden_frame();
  const Timestamp start = frame.instant - std::chrono::milliseconds(12500);
  const Timestamp received = frame.instant + std::chrono::microseconds(2345);
  const natnet::Times times{start, received, received + std::chrono::microseconds(67)};
  expect_golden("fused.natnet", with_sizes({natnet::server_info({}), natnet::encode_models(2, {}),
                                            natnet::encode_frame(frame, {}, times)}));
}

}  // namespace
}  // namespace chorus::outputs
