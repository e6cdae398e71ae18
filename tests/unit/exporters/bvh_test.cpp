// BVH, checked by our own decoder, written from the format's description, and by common/motion.
#include "common/exporters/bvh.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>
#include <sstream>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/motion/motion.h"
#include "tests/support/matchers.h"
#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

using chorus::testing::IsOk;
using chorus::testing::VectorNear;

/// A BVH file read token by token: rotations as matrices, one channel after the other.
struct Decoded {
  struct Node {
    std::string name;
    int parent = -1;
    Eigen::Vector3d offset;
    std::vector<std::string> channels;
  };
  std::vector<Node> nodes;
  double frame_time = 0;
  std::vector<std::vector<double>> frames;

  explicit Decoded(const std::string& text) {
    std::istringstream in(text);
    std::string word;
    std::vector<int> open;
    std::size_t count = 0;
    std::size_t channels = 0;
    while (in >> word && word != "MOTION") {
      if (word == "ROOT" || word == "JOINT" || word == "End") {
        Node node;
        in >> node.name;
        node.parent = open.empty() ? -1 : open.back();
        nodes.push_back(node);
        open.push_back(static_cast<int>(nodes.size()) - 1);
      } else if (word == "OFFSET") {
        auto& offset = nodes[static_cast<std::size_t>(open.back())].offset;
        in >> offset.x() >> offset.y() >> offset.z();
      } else if (word == "CHANNELS") {
        std::size_t n = 0;
        in >> n;
        channels += n;
        auto& names = nodes[static_cast<std::size_t>(open.back())].channels;
        for (names.resize(n); auto& name : names) in >> name;
      } else if (word == "}") {
        open.pop_back();
      }
    }
    in >> word >> count >> word >> word >> frame_time;
    frames.assign(count, std::vector<double>(channels));
    for (auto& frame : frames) {
      for (double& value : frame) in >> value;
    }
    EXPECT_FALSE(in.fail()) << "fewer numbers than announced";
    EXPECT_FALSE(in >> word) << "more numbers than announced";
  }

  [[nodiscard]] std::map<std::string, Eigen::Vector3d> positions(std::size_t frame) const {
    std::vector<Eigen::Matrix4d> world(nodes.size());
    std::map<std::string, Eigen::Vector3d> out;
    std::size_t channel = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      Eigen::Matrix4d local = Eigen::Matrix4d::Identity();
      local.block<3, 1>(0, 3) = nodes[i].offset;
      for (const std::string& name : nodes[i].channels) {
        const double v = frames[frame][channel++];
        const int axis = name[0] - 'X';
        if (name.ends_with("position")) {
          local(axis, 3) += v;
          continue;
        }
        const double c = std::cos(v * std::numbers::pi / 180);
        const double s = std::sin(v * std::numbers::pi / 180);
        const int u = (axis + 1) % 3;
        const int w = (axis + 2) % 3;
        Eigen::Matrix4d turn = Eigen::Matrix4d::Identity();
        turn(u, u) = turn(w, w) = c;
        turn(u, w) = -s;
        turn(w, u) = s;
        local = local * turn;
      }
      world[i] = nodes[i].parent < 0
                     ? local
                     : Eigen::Matrix4d(world[static_cast<std::size_t>(nodes[i].parent)] * local);
      out[nodes[i].name] = world[i].block<3, 1>(0, 3);
    }
    return out;
  }
};

SkeletonFit fit_of(const std::vector<Skeleton<WorldSpace>>& frames) {
  return fit_skeleton(take_of({frames}, 30.0).persons.front()).value();
}

TEST(BvhExport, AnAsymmetricPoseComesBackWhereItWas) {
  const auto person = asymmetric_person();
  const Decoded decoded(bvh_of(fit_of({person}), 30.0));
  const auto positions = decoded.positions(0);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto found = positions.find(std::string(kJointNames[j]));
    ASSERT_NE(found, positions.end()) << kJointNames[j];
    EXPECT_THAT(0.01 * found->second, VectorNear(person.joints[j].position, 2e-5))
        << kJointNames[j];
  }
}

TEST(BvhExport, SaysRateUnitAndRotationOrder) {
  const auto fit = fit_of({asymmetric_person(), asymmetric_person()});
  const std::string text = bvh_of(fit, 30.0);
  EXPECT_THAT(text, ::testing::HasSubstr("Frames: 2\nFrame Time: 0.03333333333333333\n"));
  const Decoded decoded(text);
  EXPECT_EQ(decoded.frame_time, 1.0 / 30.0);
  EXPECT_EQ(decoded.nodes[0].offset, Eigen::Vector3d::Zero()) << "or readers add it to the motion";
  EXPECT_THAT(decoded.nodes[0].channels,
              ::testing::ElementsAre("Xposition", "Yposition", "Zposition", "Zrotation",
                                     "Xrotation", "Yrotation"));
  EXPECT_EQ(decoded.frames[0].size(), 3u + 3u * kJointCount);
  const Decoded metres(bvh_of(fit, 30.0, {1.0}));
  EXPECT_NEAR(metres.frames[0][0] * 100, decoded.frames[0][0], 1e-3);
}

TEST(BvhExport, EveryFrameOfAWalkIsTheChain) {
  const auto fit = fit_of(breathing_walk());
  const Decoded decoded(bvh_of(fit, 30.0));
  ASSERT_EQ(decoded.frames.size(), fit.poses.size());
  for (std::size_t f = 0; f < fit.poses.size(); f += 7) {
    const auto chain = chain_positions(fit, fit.poses[f]);
    const auto read = decoded.positions(f);
    for (std::size_t i = 0; i < fit.joints.size(); ++i)
      ASSERT_THAT(0.01 * read.at(std::string(name_of(fit.joints[i].id))),
                  VectorNear(chain[i], 1e-6));
  }
}

TEST(BvhExport, AnglesOfAPersonWhoTurnsAndTurnsNeverJump) {
  const Decoded decoded(bvh_of(fit_of(turning()), 30.0));
  for (std::size_t f = 1; f < decoded.frames.size(); ++f) {
    for (std::size_t c = 0; c < decoded.frames[f].size(); ++c)
      ASSERT_LT(std::abs(decoded.frames[f][c] - decoded.frames[f - 1][c]), 30.0) << f << " " << c;
  }
  EXPECT_GT(std::abs(decoded.frames.back()[5] - decoded.frames.front()[5]), 1000.0)
      << "three turns";
}

TEST(BvhExport, OurOwnReaderGivesTheSameJoints) {
  const auto fit = fit_of(walk());
  const auto parsed = motion::parse_bvh(bvh_of(fit, 30.0), "walk.bvh");
  ASSERT_THAT(parsed, IsOk());
  const auto read = motion::motion_from_bvh(*parsed);
  ASSERT_THAT(read, IsOk());
  EXPECT_EQ(read->rate_hz, 30.0);
  ASSERT_EQ(read->frames.size(), fit.poses.size());
  for (std::size_t f = 0; f < fit.poses.size(); f += 11) {
    const auto chain = chain_positions(fit, fit.poses[f]);
    for (std::size_t i = 0; i < fit.joints.size(); ++i) {
      const Joint& joint = read->frames[f][fit.joints[i].id];
      EXPECT_EQ(joint.state, JointState::Tracked) << name_of(fit.joints[i].id);
      EXPECT_THAT(joint.position, VectorNear(chain[i], 1e-6));
    }
  }
}

Eigen::Quaterniond from_zxy(const std::array<double, 3>& zxy) {
  return Eigen::AngleAxisd(zxy[0], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(zxy[1], Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(zxy[2], Eigen::Vector3d::UnitY());
}

TEST(EulerZxy, EveryRotationComesBackTheLockedOnesToo) {
  for (const double x : {-90.0, -89.99, -30.0, 0.0, 60.0, 89.9999, 90.0, 120.0, 180.0}) {
    for (const double z : {-170.0, -20.0, 0.0, 95.0}) {
      for (const double y : {-120.0, 0.0, 45.0, 179.0}) {
        const auto q = from_zxy({deg(z), deg(x), deg(y)});
        const auto zxy = euler_zxy(q, {0.3, -0.2, 0.1});
        EXPECT_THAT(from_zxy(zxy), testing::RotationNear(q, 1e-6)) << z << " " << x << " " << y;
      }
    }
  }
}

TEST(EulerZxy, ChoosesTheTripleNearestToTheOneBefore) {
  const std::array<double, 3> last{deg(400), deg(100), deg(-200)};
  const auto same = euler_zxy(from_zxy(last), last);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(same[i], last[i], 1e-9);
}

}  // namespace
}  // namespace chorus::exporters
