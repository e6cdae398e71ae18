#include "common/suit/mxtp_decoder.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/matchers.h"
#include "tests/unit/suit/mxtp_bytes.h"

namespace chorus::suit {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using chorus::testing::VectorNear;
using testing::add;
using testing::Bytes;
using testing::datagram;
using testing::euler_items;
using testing::quaternion_items;

MxtpPose only_pose(MxtpDecoder& decoder, const Bytes& bytes) {
  const auto pose = decoder.take(bytes);
  EXPECT_THAT(pose, IsOk());
  EXPECT_TRUE(pose && *pose);
  return pose && *pose ? **pose : MxtpPose{};
}

void expect_t_pose(const MxtpPose& pose) {
  using enum JointId;
  EXPECT_THAT(pose.body[SpineBase].position, VectorNear(Eigen::Vector3d(0, 0.95, 0), 1e-5));
  EXPECT_THAT(pose.body[WristLeft].position, VectorNear(Eigen::Vector3d(0.75, 1.42, 0), 1e-5));
  EXPECT_THAT(pose.body[WristRight].position, VectorNear(Eigen::Vector3d(-0.75, 1.42, 0), 1e-5));
  EXPECT_THAT(pose.body[FootLeft].position, VectorNear(Eigen::Vector3d(0.1, 0.02, 0.17), 1e-5));
}

TEST(MxtpDecoder, ReadsASampleInOneDatagram) {
  MxtpDecoder decoder;
  const MxtpPose pose = only_pose(decoder, datagram({}, quaternion_items()));
  expect_t_pose(pose);
  EXPECT_EQ(pose.time_ms, 1000u);
  EXPECT_EQ(pose.character, 0);
}

TEST(MxtpDecoder, ReadsEulerAnglesOfTheSamePersonTheSame) {
  MxtpDecoder decoder;
  expect_t_pose(only_pose(decoder, datagram({.magic = "MXTP01"}, euler_items())));
}

TEST(MxtpDecoder, JoinsTheTwoPartsOfASampleInEitherOrder) {
  const Bytes first = datagram({.counter = 0, .items = 12}, quaternion_items(1, 12));
  const Bytes second = datagram({.counter = 0x81, .items = 11}, quaternion_items(13, 23));
  for (const bool turned : {false, true}) {
    MxtpDecoder decoder;
    const auto none = decoder.take(turned ? second : first);
    ASSERT_THAT(none, IsOk());
    EXPECT_FALSE(none->has_value());
    expect_t_pose(only_pose(decoder, turned ? first : second));
  }
}

TEST(MxtpDecoder, CountsASampleOfWhichAPartWasLost) {
  MxtpDecoder decoder;
  (void)decoder.take(datagram({.counter = 0, .items = 12}, quaternion_items(1, 12)));
  only_pose(decoder, datagram({.sample = 2}, quaternion_items()));
  EXPECT_EQ(decoder.incomplete(), 1u);
}

TEST(MxtpDecoder, DeliversARepeatedSampleOnce) {
  MxtpDecoder decoder;
  only_pose(decoder, datagram({}, quaternion_items()));
  const auto again = decoder.take(datagram({}, quaternion_items()));
  ASSERT_THAT(again, IsOk());
  EXPECT_FALSE(again->has_value());
}

TEST(MxtpDecoder, KnowsThePersonsName) {
  MxtpDecoder decoder;
  const std::string_view text = "name:Anna\nxmid:12\n";
  ASSERT_THAT(
      decoder.take(datagram({.magic = "MXTP12", .items = 1}, Bytes(text.begin(), text.end()))),
      IsOk());
  EXPECT_EQ(only_pose(decoder, datagram({}, quaternion_items())).name, "Anna");
}

TEST(MxtpDecoder, TakesTheHeadsSizeFromTheNullPose) {
  Bytes scale;
  add(scale, 0, 4);  // no segments, then one point
  add(scale, 1, 4);
  add(scale, 7, 2);
  add(scale, 2, 2);
  add(scale, std::string_view("pTopOfHead"));
  add(scale, 0, 4);
  for (const double value : {0.0, 0.0, 0.30}) add(scale, value);
  MxtpDecoder decoder;
  ASSERT_THAT(decoder.take(datagram({.magic = "MXTP13", .items = 1}, scale)), IsOk());
  const MxtpPose pose = only_pose(decoder, datagram({}, quaternion_items()));
  EXPECT_NEAR(pose.body[JointId::Head].position.y(), 1.58 + 0.15, 1e-5);
}

TEST(MxtpDecoder, IgnoresOtherTypes) {
  MxtpDecoder decoder;
  const auto none = decoder.take(datagram({.magic = "MXTP25", .items = 1}, Bytes(12)));
  ASSERT_THAT(none, IsOk());
  EXPECT_FALSE(none->has_value());
}

Bytes with_number(std::size_t at, double value) {
  Bytes bytes = datagram({}, quaternion_items());
  Bytes number;
  add(number, value);
  std::copy(number.begin(), number.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  return bytes;
}

TEST(MxtpDecoder, RefusesWhatNoSuitSends) {
  constexpr std::size_t kX = 28, kW = 40;
  for (const Bytes& bad :
       {Bytes{}, Bytes(23, 'M'), Bytes(760, 'x'), with_number(kX, std::nan("")),
        with_number(kX, std::numeric_limits<double>::infinity()), with_number(kX, 1e6),
        with_number(kW, 2.0), with_number(kW, 0.0), with_number(kW, std::nan("")),
        datagram({.magic = "MXTPxx"}, {}), datagram({}, quaternion_items(1, 22)),
        datagram({.items = 22}, quaternion_items(1, 22))}) {
    MxtpDecoder decoder;
    EXPECT_THAT(decoder.take(bad), FailsWith(ErrorCode::Malformed)) << bad.size();
    expect_t_pose(only_pose(decoder, datagram({.sample = 9}, quaternion_items())));
  }
}

TEST(MxtpDecoder, RefusesANinthPerson) {
  MxtpDecoder decoder;
  for (std::uint32_t id = 0; id < MxtpDecoder::kMostCharacters; ++id)
    EXPECT_THAT(decoder.take(datagram({.character = id}, quaternion_items())), IsOk());
  EXPECT_THAT(decoder.take(datagram({.character = 200}, quaternion_items())),
              FailsWith(ErrorCode::TooLarge));
}

TEST(MxtpStream, CutsDatagramsOutOfPieces) {
  Bytes all;
  for (const std::uint32_t sample : {1U, 2U, 3U}) {
    const Bytes one = datagram({.sample = sample}, quaternion_items());
    all.insert(all.end(), one.begin(), one.end());
  }
  MxtpStream stream;
  std::vector<std::uint32_t> samples;
  for (std::size_t at = 0; at < all.size(); at += 7) {
    const std::size_t size = std::min<std::size_t>(7, all.size() - at);
    ASSERT_THAT(stream.add(std::span(all).subspan(at, size)), IsOk());
    const auto one = stream.next();
    ASSERT_THAT(one, IsOk());
    if (*one) samples.push_back(read_mxtp(**one)->sample);
  }
  EXPECT_EQ(samples, (std::vector<std::uint32_t>{1, 2, 3}));
}

TEST(MxtpStream, GivesUpWhereNoDatagramBegins) {
  MxtpStream stream;
  ASSERT_THAT(stream.add(Bytes(100, 'x')), IsOk());
  EXPECT_THAT(stream.next(), FailsWith(ErrorCode::Malformed));
}

TEST(MxtpStream, HoldsABoundedNumberOfBytes) {
  MxtpStream stream;
  ASSERT_THAT(stream.add(Bytes(4 * kMaxMxtpBytes, 'M')), IsOk());
  EXPECT_THAT(stream.add(Bytes(1, 'M')), FailsWith(ErrorCode::TooLarge));
}

}  // namespace
}  // namespace chorus::suit
