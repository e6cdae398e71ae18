// chorus site register: where cells stand to one another, from what each fused of one walk.
#include <fstream>

#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/record/fused_frames.h"
#include "common/time/clock.h"
#include "fusion-server/nats/cell_records.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using ::testing::HasSubstr;

Eigen::Isometry3d b_in_a() {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.linear() = about_y(deg(40)).toRotationMatrix();
  place.translation() = Eigen::Vector3d(3.0, 0.0, -1.5);
  return place;
}

/// What a cell that stands there fused of the walk, as NDJSON.
void write_walk(const std::string& file, const Eigen::Isometry3d& cell_from_a, double from,
                double to) {
  namespace support = chorus::testing;
  std::ofstream lines(file);
  for (int i = static_cast<int>(30 * from); i < static_cast<int>(30 * to); ++i) {
    const double t = i / 30.0;
    const auto person = support::standing_person(walked(t), 0.4 * t);
    resource::FrameResource frame;
    frame.sequence = static_cast<std::uint64_t>(i);
    frame.captured = support::kStart + i * support::kFrameInterval;
    frame.source = "fusion";
    frame.space = resource::SpaceKind::World;
    frame.bodies.emplace_back();
    frame.bodies[0].id = 1;
    frame.bodies[0].captured = frame.captured;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      static_cast<Joint&>(frame.bodies[0].joints[j]) = person.joints[j];
      frame.bodies[0].joints[j].position = cell_from_a * person.joints[j].position;
    }
    lines << record::frame_line(frame);
  }
}

TEST(SiteRegister, WritesTheFileThatTheConfigurationOfASiteNames) {
  const chorus::testing::TemporaryFolder folder;
  const std::string a = (folder / "a.ndjson").string();
  const std::string b = (folder / "b.ndjson").string();
  const std::string out = (folder / "places.json").string();
  write_walk(a, Eigen::Isometry3d::Identity(), 0.0, 20.0);
  write_walk(b, b_in_a().inverse(), 0.0, 20.0);
  const Outcome done =
      run_chorus({"site", "register", "a=" + a, "b=" + b, "--origin", "a", "--out", out});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  EXPECT_THAT(done.out, HasSubstr("(origin)"));
  const auto places = nats::read_places(chorus::testing::bytes_of(out));
  ASSERT_TRUE(places);
  ASSERT_EQ(places->size(), 2U);
  const Eigen::Isometry3d& found = (*places)[1].site_from_cell;
  EXPECT_LT((found.translation() - b_in_a().translation()).norm(), 0.01);
  EXPECT_NEAR(yaw_of(found.linear()), deg(40), deg(0.3));
  EXPECT_GT((*places)[0].version, 1'700'000'000'000U) << "milliseconds since 1970";
  EXPECT_EQ((*places)[1].version, (*places)[0].version);
}

TEST(SiteRegister, SaysWhatToWalkWhenNobodyWasSeenByBoth) {
  const chorus::testing::TemporaryFolder folder;
  const std::string a = (folder / "a.ndjson").string();
  const std::string b = (folder / "b.ndjson").string();
  const std::string out = (folder / "places.json").string();
  write_walk(a, Eigen::Isometry3d::Identity(), 0.0, 8.0);
  write_walk(b, b_in_a().inverse(), 60.0, 68.0);
  const Outcome done = run_chorus({"site", "register", "a=" + a, "b=" + b, "--out", out});
  EXPECT_EQ(done.code, kExitFailed);
  EXPECT_THAT(done.error, HasSubstr("walk through the overlap"));
  EXPECT_FALSE(std::filesystem::exists(out));
}

TEST(SiteRegister, TakesMarksOnTheFloor) {
  const chorus::testing::TemporaryFolder folder;
  const std::string out = (folder / "places.json").string();
  const Outcome done = run_chorus({"site", "register", "--mark", "a:1,2=b:-3,0.5", "--mark",
                                   "a:1,4=b:-3,2.5", "--origin", "a", "--out", out});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const auto places = nats::read_places(chorus::testing::bytes_of(out));
  ASSERT_TRUE(places);
  // Found anew, the origin's place is told from the old one by its version only.
  const std::uint64_t stamped =
      static_cast<std::uint64_t>(to_unix_ns(SystemClock().now()) / 1'000'000);
  for (const auto& place : *places) {
    EXPECT_LE(place.version, stamped);
    EXPECT_GT(place.version, stamped - 60'000);
  }
  EXPECT_NEAR((*places)[1].site_from_cell.translation().x(), 4.0, 1e-9);
  EXPECT_NEAR((*places)[1].site_from_cell.translation().z(), 1.5, 1e-9);
}

TEST(SiteRegister, RefusesWhatIsNoCellAndNoMark) {
  EXPECT_THAT(run_chorus({"site", "register"}).error, HasSubstr("NAME=SOURCE"));
  EXPECT_THAT(run_chorus({"site", "register", "a=http://127.0.0.1:1/"}).error,
              HasSubstr("two cells at least"));
  const auto from = std::chrono::steady_clock::now();
  EXPECT_THAT(
      run_chorus({"site", "register", "a=http://127.0.0.1:1/", "b=http://127.0.0.1:1/"}).error,
      HasSubstr("cannot connect"));
  EXPECT_LT(std::chrono::steady_clock::now() - from, std::chrono::seconds(20)) << "not 180 s";
  EXPECT_THAT(run_chorus({"site", "register", "a"}).error, HasSubstr("NAME=SOURCE"));
  EXPECT_THAT(run_chorus({"site", "register", "--mark", "a:1,2"}).error, HasSubstr("is no mark"));
  EXPECT_THAT(run_chorus({"site", "register", "--mark", "a:1,2=b:1"}).error,
              HasSubstr("is no mark"));
  EXPECT_EQ(run_chorus({"site", "walk"}).code, kExitUsage);
}

}  // namespace
}  // namespace chorus::ctl
