#include "common/exporters/gltf.h"

#include <algorithm>

#include "common/body/bones.h"
#include "common/exporters/gltf_buffer.h"

namespace chorus::exporters {
namespace {

constexpr double kThickness = 0.08;  // Half an octahedron's width, relative to the bone's length.
constexpr double kWaist = 0.2;       // Position of the widest part, as a fraction of that length.
constexpr std::array<std::array<double, 3>, 6> kColours{{{0.90, 0.45, 0.13},
                                                         {0.16, 0.50, 0.73},
                                                         {0.20, 0.63, 0.33},
                                                         {0.70, 0.30, 0.60},
                                                         {0.85, 0.75, 0.20},
                                                         {0.45, 0.45, 0.45}}};

struct Mesh {
  std::vector<Eigen::Vector3f> places;
  std::vector<std::uint8_t> joints;
  std::vector<std::uint16_t> corners;
};

/// An octahedron from a to b that moves with `joint`.
void add_bone(Mesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::size_t joint) {
  const Eigen::Vector3d along = b - a;
  const Eigen::Vector3d side = kThickness * along.norm() * along.unitOrthogonal();
  const Eigen::Vector3d other = along.normalized().cross(side);
  const Eigen::Vector3d waist = a + kWaist * along;
  const auto first = static_cast<std::uint16_t>(mesh.places.size());
  for (const Eigen::Vector3d& place :
       {a, Eigen::Vector3d(waist + side), Eigen::Vector3d(waist + other),
        Eigen::Vector3d(waist - side), Eigen::Vector3d(waist - other), b})
    mesh.places.push_back(place.cast<float>());
  mesh.joints.insert(mesh.joints.end(), 6, static_cast<std::uint8_t>(joint));
  // Triangles, counter-clockwise seen from outside.  Corner 0 is a, 5 is b; 1 to 4 go around the
  // waist from `side` by `other`.
  for (const int corner : {0, 2, 1, 0, 3, 2, 0, 4, 3, 0, 1, 4, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 1})
    mesh.corners.push_back(static_cast<std::uint16_t>(first + corner));
}

/// The joints in the rest pose, with the lowest joint on the floor.
std::vector<Eigen::Vector3d> standing_rest(const SkeletonFit& fit) {
  std::vector<Eigen::Vector3d> rest = rest_positions(fit);
  double lowest = 0.0;
  for (const Eigen::Vector3d& place : rest) lowest = std::min(lowest, place.y());
  for (Eigen::Vector3d& place : rest) place.y() -= lowest;
  return rest;
}

nlohmann::json json_of(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

class GltfWriter {
 public:
  explicit GltfWriter(double rate_hz) : rate_hz_(rate_hz) {
    document_["asset"] = {{"version", "2.0"}, {"generator", "Chorus"}};
    document_["scene"] = 0;
    for (const char* list : {"nodes", "meshes", "materials", "skins", "animations"})
      document_[list] = nlohmann::json::array();
    document_["scenes"] = {{{"nodes", nlohmann::json::array()}}};
    animation_ = {{"name", "take"},
                  {"channels", nlohmann::json::array()},
                  {"samplers", nlohmann::json::array()}};
  }

  void person(const SkeletonFit& fit) {
    if (!times_) times_ = add_times(fit.poses.size());
    const std::string name = "person-" + std::to_string(fit.person.value);
    const auto rest = standing_rest(fit);
    auto& nodes = document_["nodes"];
    const std::size_t first = nodes.size();
    for (std::size_t i = 0; i < fit.joints.size(); ++i)
      nodes.push_back(joint_node(fit, rest, i, first));
    document_["scenes"][0]["nodes"].push_back(nodes.size());
    nodes.push_back({{"name", name}, {"children", {first}}});
    add_skin(fit, rest, first, name);
    add_mesh(fit, rest, name);
    add_motion(fit, first);
  }

  std::string finish() {
    document_["animations"].push_back(std::move(animation_));
    for (const char* list : {"meshes", "materials"}) {  // glTF does not allow empty lists
      if (document_[list].empty()) document_.erase(list);
    }
    return buffer_.pack(std::move(document_));
  }

 private:
  static nlohmann::json joint_node(const SkeletonFit& fit, const std::vector<Eigen::Vector3d>& rest,
                                   std::size_t i, std::size_t first) {
    nlohmann::json node{{"name", name_of(fit.joints[i].id)},
                        {"translation", json_of(i == 0 ? rest[0] : fit.joints[i].offset)}};
    nlohmann::json children = nlohmann::json::array();
    for (std::size_t c = i + 1; c < fit.joints.size(); ++c) {
      if (fit.joints[c].parent == i) children.push_back(first + c);
    }
    if (!children.empty()) node["children"] = std::move(children);
    return node;
  }

  std::size_t add_times(std::size_t frames) {
    std::vector<float> times;
    for (std::size_t f = 0; f < frames; ++f)
      times.push_back(static_cast<float>(static_cast<double>(f) / rate_hz_));
    return buffer_.scalars(times);
  }

  void add_skin(const SkeletonFit& fit, const std::vector<Eigen::Vector3d>& rest, std::size_t first,
                const std::string& name) {
    std::vector<Eigen::Matrix4f> joint_from_rest;
    nlohmann::json joints = nlohmann::json::array();
    for (std::size_t i = 0; i < fit.joints.size(); ++i) {
      joint_from_rest.push_back(
          Eigen::Affine3f(Eigen::Translation3f(-rest[i].cast<float>())).matrix());
      joints.push_back(first + i);
    }
    document_["skins"].push_back({{"name", name},
                                  {"joints", std::move(joints)},
                                  {"skeleton", first},
                                  {"inverseBindMatrices", buffer_.matrices(joint_from_rest)}});
  }

  void add_mesh(const SkeletonFit& fit, const std::vector<Eigen::Vector3d>& rest,
                const std::string& name) {
    Mesh mesh;
    for (std::size_t i = 1; i < fit.joints.size(); ++i)
      add_bone(mesh, rest[fit.joints[i].parent], rest[i], fit.joints[i].parent);
    if (mesh.places.empty()) return;
    const auto& colour = kColours[document_["materials"].size() % kColours.size()];
    document_["materials"].push_back({{"name", name},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {colour[0], colour[1], colour[2], 1.0}},
                                        {"metallicFactor", 0.0},
                                        {"roughnessFactor", 0.8}}}});
    const nlohmann::json attributes{
        {"POSITION", buffer_.vectors(mesh.places, ViewTarget::Vertices)},
        {"JOINTS_0", buffer_.vertex_joints(mesh.joints)},
        {"WEIGHTS_0", buffer_.vertex_weights(mesh.places.size())}};
    document_["meshes"].push_back({{"name", name},
                                   {"primitives",
                                    {{{"attributes", attributes},
                                      {"indices", buffer_.indices(mesh.corners)},
                                      {"material", document_["materials"].size() - 1}}}}});
    document_["scenes"][0]["nodes"].push_back(document_["nodes"].size());
    document_["nodes"].push_back({{"name", name + "-bones"},
                                  {"mesh", document_["meshes"].size() - 1},
                                  {"skin", document_["skins"].size() - 1}});
  }

  void add_channel(std::size_t node, const char* path, std::size_t output) {
    animation_["channels"].push_back(
        {{"sampler", animation_["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation_["samplers"].push_back(
        {{"input", *times_}, {"output", output}, {"interpolation", "LINEAR"}});
  }

  void add_motion(const SkeletonFit& fit, std::size_t first) {
    std::vector<Eigen::Vector3f> roots;
    for (const FittedPose& pose : fit.poses) roots.push_back(pose.root.cast<float>());
    add_channel(first, "translation", buffer_.vectors(roots, ViewTarget::None));
    std::vector<bool> has_child(fit.joints.size(), false);
    for (std::size_t i = 1; i < fit.joints.size(); ++i) has_child[fit.joints[i].parent] = true;
    for (std::size_t i = 0; i < fit.joints.size(); ++i) {
      if (!has_child[i]) continue;  // a joint without children never turns
      std::vector<Eigen::Quaternionf> turns;
      for (const FittedPose& pose : fit.poses)
        turns.push_back(pose.turns[i].cast<float>().normalized());
      add_channel(first + i, "rotation", buffer_.quaternions(turns));
    }
  }

  double rate_hz_;
  GltfBuffer buffer_;
  nlohmann::json document_;
  nlohmann::json animation_;
  std::optional<std::size_t> times_;
};

}  // namespace

std::string gltf_of(std::span<const SkeletonFit> fits, double rate_hz) {
  GltfWriter writer(rate_hz);
  for (const SkeletonFit& fit : fits) writer.person(fit);
  return writer.finish();
}

}  // namespace chorus::exporters
