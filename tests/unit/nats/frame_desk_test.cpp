#include "fusion-server/nats/frame_desk.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::nats {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr Timestamp kShown = from_unix_ns(1'795'246'200'000'000'000);

std::shared_ptr<const Snapshot> shot(std::uint64_t sequence) {
  auto made = std::make_shared<Snapshot>();
  made->sequence = sequence;
  made->instant = kShown + sequence * std::chrono::milliseconds(33);
  return made;
}

std::string at(std::uint64_t sequence) {
  return "{\"at\": \"" + std::to_string(to_unix_ns(shot(sequence)->instant)) + "\"}";
}

TEST(AFrameDesk, HasTheFrameOfAnInstantAndTheOneBefore) {
  FrameDesk desk;
  EXPECT_THAT(desk.frame_at(""), HasSubstr("error"));
  for (std::uint64_t i = 1; i <= 5; ++i) desk.show(shot(i), shot(i)->instant);
  EXPECT_THAT(desk.frame_at(at(3)), HasSubstr("\"sequence\":3"));
  EXPECT_EQ(desk.frame_at(at(3)), desk.frame_at(at(3)));
  EXPECT_THAT(desk.frame_at(""), HasSubstr("\"sequence\":5"));
  EXPECT_THAT(desk.frame_at(at(0)), HasSubstr("error"));
  EXPECT_THAT(desk.frame_at("nonsense"), HasSubstr("error"));
}

TEST(AFrameDesk, KeepsTenSecondsAndNoMoreThoughTheClockIsSetBack) {
  FrameDesk desk;
  for (std::uint64_t i = 1; i <= 330; ++i) desk.show(shot(i), shot(i)->instant);
  EXPECT_THAT(desk.frame_at(at(30)), Not(HasSubstr("error")));
  EXPECT_THAT(desk.frame_at(at(20)), HasSubstr("error"));
  for (std::uint64_t i = 331; i <= 1000; ++i) desk.show(shot(i), kShown - std::chrono::hours(1));
  EXPECT_THAT(desk.frame_at(at(500)), HasSubstr("error"));
  EXPECT_THAT(desk.frame_at(at(1000)), HasSubstr("\"sequence\":1000"));
}

}  // namespace
}  // namespace chorus::nats
