#include "common/service/frame_resources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/served.h"

namespace chorus::service {
namespace {

using testing::Answer;
using testing::get;
using ::testing::HasSubstr;
using testing::kFrameInterval;
using testing::kStart;
using ::testing::Not;

Timestamp instant_of(std::uint64_t sequence) {
  return kStart + kFrameInterval * static_cast<int>(sequence);
}

/// A frame with one body, whose id is 7.
FramePtr resource_frame(std::uint64_t sequence) {
  const auto pose = testing::ring_sensor(0, 6);
  const Timestamp t = instant_of(sequence);
  SensorFrame seen = testing::sensor_frame(
      "s1", t, {testing::body_seen_from(pose, testing::standing_person(), t, 7)});
  seen.sequence = sequence;
  return std::make_shared<const resource::FrameResource>(resource::to_resource(seen));
}

struct Served {
  explicit Served(std::string run = "a") : frames({std::move(run)}, {kFrameInterval * 10}) {
    frames.add_routes(router);
  }
  void publish(std::uint64_t from, std::uint64_t to) {
    for (auto i = from; i <= to; ++i) frames.publish(resource_frame(i));
  }
  [[nodiscard]] Answer ask(const std::string& path) const { return get(router, path); }

  FrameResources frames;
  http::Router router;
};

TEST(FrameResources, BeforeTheFirstFrameNothingIsReady) {
  const Served none;
  EXPECT_EQ(none.ask("/frame").status, 503);
  EXPECT_EQ(none.ask("/skeletons/").status, 503);
  EXPECT_EQ(none.ask("/skeletons/7").status, 503);
  EXPECT_EQ(none.ask("/frames/1").status, 404);
}

TEST(FrameResources, AreRevalidatedWhenLiveAndImmutableWhenNumbered) {
  Served served;
  served.publish(1, 25);
  const Answer live = served.ask("/frame");
  EXPECT_THAT(live.head, HasSubstr("Content-Location: frames/25\r\n"));
  EXPECT_THAT(live.head, HasSubstr("Cache-Control: no-cache"));
  const Answer kept = served.ask("/frames/20");
  EXPECT_EQ(kept.status, 200);
  EXPECT_THAT(kept.head, HasSubstr("immutable"));
  EXPECT_THAT(kept.head, Not(HasSubstr("Content-Location")));
  EXPECT_EQ(served.ask("/frames/15").status, 410);
  EXPECT_EQ(served.ask("/frames/26").status, 404);
  EXPECT_EQ(served.ask("/frames/020").status, 404) << "one name for one frame";
}

TEST(FrameResources, TheFrameOfAnInstantLiesBetweenItsNeighbours) {
  Served served;
  served.publish(1, 25);
  const Timestamp between = instant_of(20) + kFrameInterval / 2;
  const Answer at = served.ask("/frame?at=" + to_iso8601(between));
  EXPECT_EQ(at.status, 200);
  EXPECT_THAT(at.body, HasSubstr(std::to_string(to_unix_ns(between))));
  EXPECT_EQ(served.ask("/frame?at=" + std::to_string(to_unix_ns(instant_of(1)))).status, 410);
  EXPECT_EQ(served.ask("/frame?at=" + std::to_string(to_unix_ns(instant_of(26)))).status, 404);
  EXPECT_EQ(served.ask("/frame?at=noon").status, 400);
}

TEST(FrameResources, BodiesHaveOneNameEach) {
  Served served;
  served.publish(1, 1);
  EXPECT_THAT(served.ask("/skeletons/").body, HasSubstr("\"7\""));
  EXPECT_EQ(served.ask("/skeletons/7").status, 200);
  for (const char* other : {"8", "007", "+7", "x", "99999999999999999999999"}) {
    const Answer none = served.ask("/skeletons/" + std::string(other));
    EXPECT_EQ(none.status, 404) << other;
    EXPECT_THAT(none.body, HasSubstr("only the bodies 7"));
  }
}

TEST(FrameResources, EtagsDifferFromRunToRunAndFromFrameToFrame) {
  const auto tag = [](const char* run, std::uint64_t sequence) {
    Served served(run);
    served.publish(sequence, sequence);
    return served.ask("/frame").etag;
  };
  EXPECT_EQ(tag("a", 1), tag("a", 1));
  EXPECT_NE(tag("a", 1), tag("b", 1));
  EXPECT_NE(tag("a", 1), tag("a", 2));
}

}  // namespace
}  // namespace chorus::service
