// glTF, checked by our own decoder, written from the glTF 2.0 specification: it animates nodes and
// skins vertices as a viewer does. tests/system uses the Khronos validator and three.js.
#include "common/exporters/gltf.h"

#include <gmock/gmock.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "tests/support/matchers.h"
#include "tests/unit/exporters/poses.h"

namespace chorus::exporters {
namespace {

using chorus::testing::VectorNear;
using nlohmann::json;

struct DecodedGltf {
  json document;
  std::string binary;

  explicit DecodedGltf(const std::string& glb) {
    EXPECT_EQ(glb.substr(0, 4), "glTF");
    EXPECT_EQ(u32(glb, 4), 2u);
    EXPECT_EQ(u32(glb, 8), glb.size());
    const std::size_t length = u32(glb, 12);
    EXPECT_EQ(glb.substr(16, 4), "JSON");
    document = json::parse(glb.substr(20, length));
    EXPECT_EQ(glb.substr(20 + length + 4, 4), std::string("BIN\0", 4));
    EXPECT_EQ((20 + length) % 4, 0u);
    binary = glb.substr(20 + length + 8, u32(glb, 20 + length));
    EXPECT_EQ(document["buffers"][0]["byteLength"], binary.size());
  }
  static std::uint32_t u32(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
  }
  /// Element `i` of an accessor as numbers.
  [[nodiscard]] std::vector<double> element(std::size_t accessor, std::size_t i) const {
    const json& a = document["accessors"][accessor];
    const json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
    static const std::map<std::string, std::size_t> kWidth{
        {"SCALAR", 1}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
    static const std::map<int, std::size_t> kBytes{{5126, 4}, {5123, 2}, {5121, 1}};
    const std::size_t width = kWidth.at(a["type"]);
    const std::size_t bytes = kBytes.at(a["componentType"]);
    EXPECT_LT(i, a["count"].get<std::size_t>());
    std::vector<double> out;
    for (std::size_t k = 0; k < width; ++k) {
      const char* at =
          binary.data() + view["byteOffset"].get<std::size_t>() + (i * width + k) * bytes;
      float f = 0;
      std::uint16_t s = 0;
      if (bytes == 4) std::memcpy(&f, at, 4);
      if (bytes == 2) std::memcpy(&s, at, 2);
      out.push_back(bytes == 4   ? f
                    : bytes == 2 ? s
                                 : static_cast<double>(static_cast<unsigned char>(*at)));
    }
    return out;
  }
  [[nodiscard]] std::size_t count(std::size_t accessor) const {
    return document["accessors"][accessor]["count"];
  }

  /// World matrices of all nodes at one key of the animation, or at rest.
  [[nodiscard]] std::vector<Eigen::Matrix4d> world(std::optional<std::size_t> key) const {
    const std::size_t n = document["nodes"].size();
    std::vector<Eigen::Vector3d> shift(n, Eigen::Vector3d::Zero());
    std::vector<Eigen::Quaterniond> turn(n, Eigen::Quaterniond::Identity());
    for (std::size_t i = 0; i < n; ++i) {
      const json t = document["nodes"][i].value("translation", json{0.0, 0.0, 0.0});
      shift[i] = Eigen::Vector3d(t[0].get<double>(), t[1].get<double>(), t[2].get<double>());
    }
    for (const json& channel : key ? document["animations"][0]["channels"] : json::array()) {
      const json& sampler =
          document["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
      const auto v = element(sampler["output"], *key);
      const std::size_t node = channel["target"]["node"];
      if (channel["target"]["path"] == "translation")
        shift[node] = Eigen::Vector3d(v[0], v[1], v[2]);
      if (channel["target"]["path"] == "rotation")
        turn[node] = Eigen::Quaterniond(v[3], v[0], v[1], v[2]);
    }
    std::vector<Eigen::Matrix4d> out(n, Eigen::Matrix4d::Identity());
    const auto descend = [&](auto&& self, std::size_t i, const Eigen::Matrix4d& parent) -> void {
      out[i] = parent * (Eigen::Translation3d(shift[i]) * turn[i]).matrix();
      for (const json& child : document["nodes"][i].value("children", json::array()))
        self(self, child, out[i]);
    };
    for (const json& root : document["scenes"][0]["nodes"])
      descend(descend, root, Eigen::Matrix4d::Identity());
    return out;
  }
};

std::vector<SkeletonFit> fits_of(const Take& take) {
  std::vector<SkeletonFit> fits;
  for (const auto& track : take.persons) fits.push_back(fit_skeleton(track).value());
  return fits;
}

TEST(GltfExport, AnAsymmetricPoseComesBackWhereItWas) {
  const auto person = asymmetric_person();
  const auto fits = fits_of(take_of({{person}}, 30));
  const DecodedGltf gltf(gltf_of(fits, 30));
  const auto world = gltf.world(0);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const auto joint = joint_named(gltf.document["nodes"][i]["name"].get<std::string>());
    ASSERT_TRUE(joint);
    EXPECT_THAT(Eigen::Vector3d(world[i].block<3, 1>(0, 3)),
                VectorNear(person[*joint].position, 1e-5));
  }
}

TEST(GltfExport, AnimatesEveryPersonOnOneTimeLine) {
  const auto fits = fits_of(take_of({walk(), breathing_walk()}, 30));
  const DecodedGltf gltf(gltf_of(fits, 30));
  ASSERT_EQ(gltf.document["skins"].size(), 2u);
  ASSERT_EQ(gltf.document["animations"].size(), 1u);
  const std::size_t keys = fits[0].poses.size();
  for (const json& sampler : gltf.document["animations"][0]["samplers"]) {
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    EXPECT_EQ(gltf.count(sampler["input"]), keys);
    EXPECT_EQ(gltf.count(sampler["output"]), keys);
    EXPECT_NEAR(gltf.element(sampler["input"], 30)[0], 1.0, 1e-6);
  }
  for (const std::size_t key : {std::size_t{0}, keys / 2, keys - 1}) {
    const auto world = gltf.world(key);
    for (std::size_t p = 0; p < 2; ++p) {
      const auto chain = chain_positions(fits[p], fits[p].poses[key]);
      for (std::size_t i = 0; i < chain.size(); ++i) {
        const std::size_t node = gltf.document["skins"][p]["joints"][i];
        ASSERT_THAT(Eigen::Vector3d(world[node].block<3, 1>(0, 3)), VectorNear(chain[i], 1e-5));
      }
    }
  }
}

TEST(GltfExport, RotationsAreUnitAndContinuous) {
  const auto fits = fits_of(take_of({turning()}, 30));
  const DecodedGltf gltf(gltf_of(fits, 30));
  for (const json& channel : gltf.document["animations"][0]["channels"]) {
    if (channel["target"]["path"] != "rotation") continue;
    const json& sampler =
        gltf.document["animations"][0]["samplers"][channel["sampler"].get<std::size_t>()];
    auto last = gltf.element(sampler["output"], 0);
    for (std::size_t key = 0; key < fits[0].poses.size(); ++key) {
      const auto q = gltf.element(sampler["output"], key);
      const double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
      const double dot = q[0] * last[0] + q[1] * last[1] + q[2] * last[2] + q[3] * last[3];
      ASSERT_NEAR(norm, 1.0, 1e-6);
      ASSERT_GE(dot, 0.0);
      last = q;
    }
  }
}

/// A vertex as a viewer shows it: joint matrix times inverse bind matrix.
Eigen::Vector3d skinned(const DecodedGltf& gltf, const std::vector<Eigen::Matrix4d>& world,
                        std::size_t vertex) {
  const json& skin = gltf.document["skins"][0];
  const json& attributes = gltf.document["meshes"][0]["primitives"][0]["attributes"];
  const auto place = gltf.element(attributes["POSITION"], vertex);
  const auto joint = static_cast<std::size_t>(gltf.element(attributes["JOINTS_0"], vertex)[0]);
  EXPECT_EQ(gltf.element(attributes["WEIGHTS_0"], vertex), (std::vector<double>{1, 0, 0, 0}));
  const auto inverse = gltf.element(skin["inverseBindMatrices"], joint);
  const Eigen::Matrix4d bind = Eigen::Map<const Eigen::Matrix4d>(inverse.data());
  const Eigen::Vector4d shown = world[skin["joints"][joint].get<std::size_t>()] * bind *
                                Eigen::Vector4d(place[0], place[1], place[2], 1);
  return shown.head<3>();
}

TEST(GltfExport, TheMeshStandsOnTheFloorAtRestAndFollowsTheJoints) {
  const auto person = asymmetric_person();
  const DecodedGltf gltf(gltf_of(fits_of(take_of({{person}}, 30)), 30));
  const json& primitive = gltf.document["meshes"][0]["primitives"][0];
  const std::size_t vertices = gltf.count(primitive["attributes"]["POSITION"]);
  ASSERT_EQ(vertices, 6 * (kJointCount - 1));
  const auto rest = gltf.world(std::nullopt);
  double lowest = 1e9;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto place = gltf.element(primitive["attributes"]["POSITION"], v);
    EXPECT_THAT(skinned(gltf, rest, v),
                VectorNear(Eigen::Vector3d(place[0], place[1], place[2]), 1e-5));
    lowest = std::min(lowest, place[1]);
  }
  EXPECT_NEAR(lowest, 0.0, 0.02);
  // Each bone has six vertices; the first lies at its parent joint, the last at its child joint.
  // The bones are in the order of kBones.
  const auto posed = gltf.world(0);
  for (std::size_t b = 0; b < kBones.size(); ++b) {
    EXPECT_THAT(skinned(gltf, posed, 6 * b), VectorNear(person[kBones[b].parent].position, 1e-5));
    EXPECT_THAT(skinned(gltf, posed, 6 * b + 5),
                VectorNear(person[kBones[b].child].position, 1e-5));
  }
}

TEST(GltfExport, TrianglesFaceOutwards) {
  const DecodedGltf gltf(gltf_of(fits_of(take_of({{asymmetric_person()}}, 30)), 30));
  const json& primitive = gltf.document["meshes"][0]["primitives"][0];
  const std::size_t corners = gltf.count(primitive["indices"]);
  const auto place = [&](std::size_t corner) {
    const auto index = static_cast<std::size_t>(gltf.element(primitive["indices"], corner)[0]);
    const auto v = gltf.element(primitive["attributes"]["POSITION"], index);
    return std::pair(index, Eigen::Vector3d(v[0], v[1], v[2]));
  };
  for (std::size_t t = 0; t < corners; t += 3) {
    const auto [index, a] = place(t);
    const Eigen::Vector3d b = place(t + 1).second;
    const Eigen::Vector3d c = place(t + 2).second;
    const auto low = gltf.element(primitive["attributes"]["POSITION"], index / 6 * 6);
    const auto high = gltf.element(primitive["attributes"]["POSITION"], index / 6 * 6 + 5);
    const Eigen::Vector3d inside = 0.75 * Eigen::Vector3d(low[0], low[1], low[2]) +
                                   0.25 * Eigen::Vector3d(high[0], high[1], high[2]);
    EXPECT_GT((b - a).cross(c - a).dot((a + b + c) / 3 - inside), 0.0) << t;
  }
}

TEST(GltfExport, APersonOfOneJointHasNoMeshAndNoEmptyLists) {
  Skeleton<WorldSpace> point;
  point[JointId::SpineBase] = asymmetric_person()[JointId::SpineBase];
  const DecodedGltf gltf(gltf_of(fits_of(take_of({{point}}, 30)), 30));
  EXPECT_FALSE(gltf.document.contains("meshes"));
  for (const auto& [key, value] : gltf.document.items()) EXPECT_FALSE(value.empty()) << key;
}

}  // namespace
}  // namespace chorus::exporters
