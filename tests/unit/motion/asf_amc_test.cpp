#include "common/motion/asf_amc.h"

#include <gmock/gmock.h>

#include <fstream>
#include <sstream>

#include "common/motion/cmu_walk.h"
#include "common/motion/motion.h"

namespace chorus::motion {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kTwoBones = R"(:version 1.10
:units
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name upper
     direction 0 -1 0
     length 10
     axis 0 0 0 XYZ
    dof rx ry rz
  end
  begin
     id 2
     name lower
     direction 0 -1 0
     length 5
     axis 0 90 0 XYZ
    dof rx
  end
:hierarchy
  begin
    root upper
    upper lower
  end
)";

constexpr double kUnit = 0.0254 / 0.45;  // metres per unit, mocap.cs.cmu.edu FAQ: 0.056444

AsfSkeleton two_bones() { return parse_asf(kTwoBones, "two.asf").value(); }

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(Asf, LengthsAreInchesDividedByTheUnit) {
  const AsfSkeleton skeleton = two_bones();
  ASSERT_EQ(skeleton.bones.size(), 3u);
  EXPECT_NEAR(skeleton.metres_per_unit, 0.056444, 1e-6);
  EXPECT_NEAR(skeleton.bones[1].reach.norm(), 10 * kUnit, 1e-12);
  EXPECT_EQ(skeleton.channel_count, 10u);
}

TEST(Amc, ABoneTurnsAboutItsOwnAxisFrame) {
  const AsfSkeleton skeleton = two_bones();
  // The lower bone's axis frame is rotated by 90 deg about y, so its x axis is the world's -z, and
  // rotating by +90 deg about that axis takes -y to -x.
  const auto frames =
      parse_amc(":FULLY-SPECIFIED\n:DEGREES\n1\nroot 1 2 3 0 0 0\nupper 0 0 0\nlower 90\n", "a.amc",
                skeleton);
  ASSERT_TRUE(frames) << to_string(frames.error());
  const auto ends = bone_ends(skeleton, frames->front());
  EXPECT_TRUE(ends[0].isApprox(kUnit * Eigen::Vector3d(1, 2, 3), 1e-9));
  EXPECT_TRUE(ends[1].isApprox(kUnit * Eigen::Vector3d(1, -8, 3), 1e-9));
  EXPECT_TRUE((ends[2] - ends[1]).isApprox(kUnit * Eigen::Vector3d(-5, 0, 0), 1e-9))
      << (ends[2] - ends[1]).transpose() / kUnit;
}

TEST(Amc, RootAnglesTurnAboutFixedAxesXFirst) {
  const AsfSkeleton skeleton = two_bones();
  // About x first: -y goes to -z; then 90 deg about z leaves it there.  The other order would give
  // -x or +x.
  const auto frames = parse_amc("1\nroot 0 0 0 90 0 90\nupper 0 0 0\nlower 0\n", "a.amc", skeleton);
  ASSERT_TRUE(frames) << to_string(frames.error());
  const auto ends = bone_ends(skeleton, frames->front());
  EXPECT_TRUE(ends[1].isApprox(kUnit * Eigen::Vector3d(0, 0, -10), 1e-9)) << ends[1].transpose();
}

struct Broken {
  std::string_view from, to, line, why;
};

TEST(Asf, RefusesWhatItDoesNotUnderstandAndSaysWhere) {
  const Broken cases[] = {
      {"direction 0 -1 0", "direction 0 x 0", "two.asf:14", "'x' is not a finite number"},
      {"direction 0 -1 0", "direction 0 nan 0", "two.asf:14", "'nan' is not a finite number"},
      {"length 10", "length", "two.asf:15", "expected 1 numbers"},
      {"axis 0 0 0 XYZ", "axis 0 0 0 ZYX", "two.asf:16", "must be XYZ"},
      {"dof rx ry rz", "dof ry rx", "two.asf:17", "subset of rx ry rz"},
      {"upper lower", "upper elbow", "two.asf:30", "no bone 'elbow'"},
      {"root upper", "root lower", "two.asf:30", "'upper' is not part of the hierarchy"},
      {"upper lower", "upper upper", "two.asf:30", "two parents"},
      {"    upper lower\n", "", "two.asf:30", "hangs 1 of 2 bones"},
      {"length 0.45", "length 0", "two.asf:3", "above zero"},
      {"angle deg", "angle rad", "two.asf:4", "only angles in deg"},
      {"orientation 0 0 0", "orientation 0 90 0", "two.asf:9", "not supported"},
  };
  for (const Broken& each : cases) {
    const auto parsed = parse_asf(replaced(std::string(kTwoBones), each.from, each.to), "two.asf");
    ASSERT_FALSE(parsed) << each.why;
    EXPECT_EQ(parsed.error().context, each.line) << parsed.error().message;
    EXPECT_THAT(parsed.error().message, HasSubstr(std::string(each.why)));
  }
  EXPECT_FALSE(parse_asf("", "empty.asf"));
  EXPECT_FALSE(parse_asf(kTwoBones.substr(0, 200), "cut.asf"));
}

TEST(Amc, RefusesBrokenFramesAndSaysWhere) {
  const AsfSkeleton skeleton = two_bones();
  const std::pair<std::string_view, std::string_view> cases[] = {
      {"", "there is no frame"},
      {"root 0 0 0 0 0 0\n", "expected frame number 1"},
      {"2\nroot 0 0 0 0 0 0\nupper 0 0 0\nlower 0\n", "expected frame 1"},
      {"1\nroot 0 0 0 0 0 0\nupper 0 0 0\n", "last frame lacks lower"},
      {"1\nroot 0 0 0 0 0 0\nlower 0\n2\n", "lacks upper"},
      {"1\nroot 0 0 0 0 0\n", "expected 6 numbers for root"},
      {"1\nupper 0 0 0 0\n", "expected 3 numbers for upper"},
      {"1\ntail 0\n", "no bone 'tail'"},
      {"1\nlower inf\n", "'inf' is not a finite number"},
      {":RADIANS\n1\n", "only motion in degrees"},
  };
  for (const auto& [text, why] : cases) {
    const auto parsed = parse_amc(text, "a.amc", skeleton);
    ASSERT_FALSE(parsed) << why;
    EXPECT_THAT(parsed.error().message, HasSubstr(std::string(why)));
    EXPECT_THAT(parsed.error().context, HasSubstr("a.amc:"));
  }
}

TEST(Amc, AnyCutOrFlippedByteIsHandled) {
  const AsfSkeleton skeleton = two_bones();
  for (std::size_t i = 0; i < kTwoBones.size(); ++i) {
    std::string text(kTwoBones);
    text[i] = static_cast<char>(text[i] ^ 0x15);
    (void)parse_asf(text, "flipped.asf");
    (void)parse_asf(kTwoBones.substr(0, i), "cut.asf");
  }
  EXPECT_TRUE(bone_ends(skeleton, {}).front().isZero()) << "a frame without channels";
}

TEST(CmuWalk, IsBuiltInWhole) {
  const CmuWalk& walk = cmu_walk();
  EXPECT_EQ(walk.skeleton.bones.size(), 31u);
  ASSERT_EQ(walk.takes.size(), 2u);
  EXPECT_EQ(walk.takes[0].size(), 343u);
  EXPECT_EQ(walk.takes[1].size(), 298u);
}

TEST(CmuWalk, IsTheFileThatIsShipped) {
  std::ifstream file("common/motion/assets/02_01.amc");
  std::stringstream text;
  text << file.rdbuf();
  const auto frames = parse_amc(text.str(), "02_01.amc", cmu_walk().skeleton);
  ASSERT_TRUE(frames) << to_string(frames.error());
  EXPECT_EQ(*frames, cmu_walk().takes[0]);
}

}  // namespace
}  // namespace chorus::motion
