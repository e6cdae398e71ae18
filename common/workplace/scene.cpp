#include "common/workplace/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/rotation.h"

namespace chorus::workplace {
namespace {

using Eigen::Vector3d;

constexpr double kFarthest = 100.0;    // [m] of a room
constexpr std::size_t kMaxItems = 64;  // points, boxes, marks; each is scored for each person

void read_place(ConfigReader& reader, const char* key, Vector3d& out) {
  std::vector<double> values;
  reader.read(key, values);
  if (values.size() != 3) return reader.complain(key, "needs three numbers, in metres");
  out = Vector3d(values[0], values[1], values[2]);
  if (!out.allFinite() || out.cwiseAbs().maxCoeff() > kFarthest)
    reader.complain(key, "is farther than 100 m away");
}

void read_name(ConfigReader& reader, std::string& out) {
  reader.read("name", out);
  if (out.empty()) reader.complain("name", "is missing");
}

void read_box(ConfigReader reader, Scene& out) {
  SceneBox box;
  read_name(reader, box.name);
  read_place(reader, "centre_m", box.centre);
  read_place(reader, "size_m", box.size);
  if (!(box.size.minCoeff() > 0.0)) reader.complain("size_m", "must be above zero");
  reader.read_deg("yaw_deg", box.yaw, -360.0, 360.0);
  reader.read("obstacle", box.obstacle);
  out.boxes.push_back(std::move(box));
}

void read_mark(ConfigReader reader, Scene& out) {
  constexpr double kDay = 86'400.0;
  HeldMark mark;
  std::string name;
  reader.read("prop", name);
  const auto found = std::ranges::find(out.props, name, &Prop::name);
  if (found == out.props.end()) reader.complain("prop", "'" + name + "' is none of the props");
  mark.prop = static_cast<std::size_t>(found - out.props.begin());
  reader.read("from_s", mark.from, 0.0, kDay);
  mark.until = kDay;
  reader.read("to_s", mark.until, 0.0, kDay);
  if (mark.until <= mark.from) reader.complain("to_s", "must be later than from_s");
  int person = -1;
  reader.read("person", person, 0, std::numeric_limits<int>::max());
  if (person >= 0) mark.person = static_cast<std::uint64_t>(person);
  out.held.push_back(mark);
}

}  // namespace

Result<Scene> read_scene(std::string_view text, std::string_view origin) {
  auto root = ConfigReader::parse(text, origin);
  if (!root) return pass(root);
  Scene scene;
  root->read("title", scene.title);
  for (ConfigReader& each : root->items("points")) {
    ScenePoint point;
    read_name(each, point.name);
    read_place(each, "at_m", point.at);
    scene.points.push_back(std::move(point));
  }
  for (const ConfigReader& each : root->items("boxes")) read_box(each, scene);
  scene.props = read_props(*root);
  for (const ConfigReader& each : root->items("held")) read_mark(each, scene);
  root->read_deg("view_deg", scene.view, 1.0, 90.0);
  if (scene.points.size() + scene.boxes.size() + scene.held.size() > kMaxItems)
    root->complain("points", "points, boxes and marks are 64 at most");
  if (auto ok = root->finish(); !ok) return pass(ok);
  return scene;
}

std::optional<double> entered(const SceneBox& box, const Vector3d& a, const Vector3d& b) {
  const Eigen::Quaterniond box_from_world = about_y(-box.yaw);
  const Vector3d from = box_from_world * (a - box.centre);
  const Vector3d way = box_from_world * (b - a);
  double in = 0.0;
  double out = 1.0;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * box.size[axis];
    if (std::abs(way[axis]) < 1e-12) {
      if (!(std::abs(from[axis]) <= half)) return std::nullopt;
      continue;
    }
    const double one = (-half - from[axis]) / way[axis];
    const double other = (half - from[axis]) / way[axis];
    in = std::max(in, std::min(one, other));
    out = std::min(out, std::max(one, other));
  }
  if (!(in <= out)) return std::nullopt;
  return in;
}

std::string obstacle_between(const Scene& scene, const Vector3d& a, const Vector3d& b) {
  constexpr double kContact = 0.05;  // [m]; half a hand
  const double length = (b - a).norm();
  if (!(length > kContact)) return {};
  const Vector3d near = b - kContact / length * (b - a);
  double first = std::numeric_limits<double>::infinity();
  std::string name;
  for (const SceneBox& box : scene.boxes) {
    const auto at = box.obstacle ? entered(box, a, near) : std::nullopt;
    if (!at || *at >= first) continue;
    first = *at;
    name = box.name;
  }
  return name;
}

}  // namespace chorus::workplace
