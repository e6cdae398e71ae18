#include "common/motion/trc.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/support/matchers.h"

namespace chorus::motion {
namespace {

using chorus::testing::FailsWith;
using chorus::testing::IsOk;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::string_view kWalk =
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\n"
    "50\t50\t3\t2\tmm\t50\n"
    "Frame#\tTime\tRHip\t\t\tNeck\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "1\t0.00\t100\t900\t0\t0\t1400\t10\n"
    "2\t0.02\t\t\t\t0\t1400\t20\t\n"
    "3\t0.10\t100\tNaN\t0\t0\t0\t0\r\n";

TEST(Trc, ReadsPointsTimesAndWhatWasNotSeen) {
  const auto read = parse_trc(kWalk, "walk.trc");
  ASSERT_THAT(read, IsOk());
  EXPECT_THAT(read->labels, ElementsAre("RHip", "Neck"));
  ASSERT_EQ(read->frames.size(), 3u);
  EXPECT_THAT(read->times, ElementsAre(0.0, 0.02, 0.1)) << "its own times, not its rate";
  EXPECT_NEAR(read->frames[0][0].position.y(), 0.9, 1e-6) << "millimetres";
  EXPECT_FALSE(read->frames[1][0].valid()) << "empty cells";
  EXPECT_TRUE(read->frames[1][1].valid());
  EXPECT_FALSE(read->frames[2][0].valid()) << "NaN";
  EXPECT_FALSE(read->frames[2][1].valid()) << "zeros";
  EXPECT_TRUE(read->notes.empty());
  const auto motion = motion_from_markers(*read);
  ASSERT_THAT(motion, IsOk());
  EXPECT_TRUE(motion->subjects[0].motion.frames[0][JointId::HipRight].seen());
}

std::string with(std::string_view from, std::string_view to) {
  std::string text(kWalk);
  return text.replace(text.find(from), from.size(), to);
}

TEST(Trc, CommasAndBlanksSeparateToo) {
  for (const char separator : {',', ' '}) {
    std::string text(kWalk.substr(0, kWalk.find("2\t0.02")));
    std::replace(text.begin(), text.end(), '\t', separator);
    const auto read = parse_trc(text, "walk.trc");
    ASSERT_THAT(read, IsOk()) << separator;
    EXPECT_NEAR(read->frames.at(0).at(1).position.y(), 1.4, 1e-6);
  }
}

TEST(Trc, SalvagesAndSaysSo) {
  EXPECT_THAT(parse_trc(with("\t3\t2\tmm", "\t9\t2\tmm"), "a.trc")->notes,
              ElementsAre(HasSubstr("announces 9 frames and holds 3")));
  const auto back = parse_trc(with("3\t0.10", "3\t0.01"), "b.trc");
  ASSERT_THAT(back, IsOk());
  EXPECT_TRUE(back->times.empty());
  EXPECT_THAT(back->notes, ElementsAre(HasSubstr("do not ascend")));
  const auto broken = parse_trc(with("2\t0.02", "?\t?"), "c.trc");
  ASSERT_THAT(broken, IsOk());
  EXPECT_EQ(broken->frames.size(), 2u);
  EXPECT_THAT(broken->notes.back(), HasSubstr("1 rows cannot be read"));
}

TEST(Trc, RefusesWhatItCannotKnow) {
  EXPECT_THAT(parse_trc("", "a.trc"), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(parse_trc(with("\tmm", "\tspan"), "b.trc"), FailsWith(ErrorCode::Malformed));
  EXPECT_THAT(parse_trc(with("\tmm", "\tspan"), "b.trc", 0.001), IsOk()) << "--unit says it";
  for (std::size_t size = 0; size < kWalk.size(); ++size)
    static_cast<void>(parse_trc(kWalk.substr(0, size), "cut.trc"));
}

}  // namespace
}  // namespace chorus::motion
