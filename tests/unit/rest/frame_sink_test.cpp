#include "fusion-server/rest/frame_sink.h"

#include <gtest/gtest.h>

#include "tests/unit/rest/asked.h"

namespace chorus::rest {
namespace {

using testing::kStart;

TEST(FrameSink, SnapshotsBecomeFrames) {
  http::Router router;
  service::FrameResources frames({"run1"}, {});
  frames.add_routes(router);
  FrameSink sink(frames);
  for (std::uint64_t i = 1; i <= 3; ++i) sink.publish(snapshot(i));
  EXPECT_NE(body(ask(router, "/frame"), "text/turtle").find("<frames/3> a ch:Frame"),
            std::string::npos);
  EXPECT_NE(body(ask(router, "/skeletons/7"), "text/turtle").find("-Head>"), std::string::npos);
}

TEST(FrameSink, PredictsTheNewestFrameByAQuarterOfASecondAtMost) {
  service::FrameResources frames({"run1"}, {});
  FrameSink sink(frames);
  EXPECT_EQ(sink.predicted(kStart), nullptr);
  auto moving = *snapshot(1);
  for (FusedBody& body : moving.bodies) {
    body.motion.emplace();
    for (JointMotion& motion : *body.motion) motion = {Eigen::Vector3d(0, 0, 1), 0.01};
  }
  const Timestamp instant = moving.instant;
  sink.publish(std::make_shared<const Snapshot>(moving));
  const auto head_at = [&](Duration after) {
    return sink.predicted(instant + after)->bodies.at(0).joints[index_of(JointId::Head)];
  };
  const auto before = head_at(Duration{0});
  const auto later = head_at(std::chrono::milliseconds(50));
  EXPECT_NEAR(later.position.z() - before.position.z(), 0.047, 0.002);
  EXPECT_GT(*later.variance, *before.variance);
  EXPECT_EQ(sink.predicted(instant + std::chrono::seconds(9))->captured,
            instant + FrameSink::kFarthest);
}

TEST(FrameSink, TheFrameOfNowIsServedWherePredictionsAreMade) {
  http::Router router;
  service::FrameResources frames({"run1"}, {});
  frames.add_routes(router);
  FrameSink sink(frames);
  const auto now = [&] { return ask(router, "/frame", {{"at", "now"}}); };
  EXPECT_EQ(now().error().code, ErrorCode::InvalidArgument);
  frames.predict_with([&] { return sink.predicted(kStart + std::chrono::hours(1)); });
  EXPECT_EQ(now().error().code, ErrorCode::Unavailable);
  const auto newest = snapshot(1);
  sink.publish(newest);
  const std::string then = std::to_string(to_unix_ns(newest->instant + FrameSink::kFarthest));
  EXPECT_NE(body(now(), "application/json").find(then), std::string::npos);
}

}  // namespace
}  // namespace chorus::rest
