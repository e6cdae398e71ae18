#include "common/workplace/prop.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "common/body/bones.h"
#include "common/geometry/rotation.h"

namespace chorus::workplace {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using enum JointId;

const Vector3d kUpward = Vector3d::UnitY();
/// A line of which less than this is across an axis gives no direction across it.
constexpr double kLeastAcross = 0.2;
/// What the turn about a single limb may be wrong by; a hand turns by 90 degrees either way.
constexpr double kUnseenTurn = std::numbers::pi / 6.0;

/// Standard deviation per axis; zero: not stated.
double sigma_of(const Joint& joint) {
  if (!joint.covariance.known()) return 0.0;
  return std::sqrt(std::max(0.0, joint.covariance.matrix().trace() / 3.0));
}

/// The part of `line` across `axis`, as a unit vector; none if little of it is.
std::optional<Vector3d> square_to(const Vector3d& line, const Vector3d& axis) {
  const Vector3d rest = line - line.dot(axis) * axis;
  if (!(rest.norm() > kLeastAcross * line.norm())) return std::nullopt;
  return rest.normalized();
}

std::optional<Vector3d> limb_of(const Skeleton<WorldSpace>& body, JointId end) {
  const Joint& from = body[lever_of(end)];
  if (!from.seen() || !body[end].seen()) return std::nullopt;
  const Vector3d line = body[end].position - from.position;
  if (!(line.norm() > 0.0)) return std::nullopt;
  return line.normalized();
}

/// Where the body looks, by the line between hips or shoulders.
Vector3d ahead(const Skeleton<WorldSpace>& body) {
  for (const auto& [left, right] : {std::pair{ShoulderLeft, ShoulderRight}, {HipLeft, HipRight}}) {
    if (!body[left].seen() || !body[right].seen()) continue;
    const auto across = square_to(body[left].position - body[right].position, kUpward);
    if (across) return across->cross(kUpward);
  }
  return Vector3d::UnitZ();
}

Matrix3d axes(const Vector3d& x, const Vector3d& y, const Vector3d& z) {
  Matrix3d turn;
  turn << x, y, z;
  return turn;
}

/// +z along `limb`, +y up across it; an upright limb has its y ahead or behind.
Matrix3d along_limb(const Vector3d& limb, const Vector3d& forward, bool level) {
  const auto flat = square_to(limb, kUpward);
  if (level) {
    const Vector3d z = flat.value_or(forward);
    return axes(kUpward.cross(z), kUpward, z);
  }
  const Vector3d side = limb.y() > 0.0 ? Vector3d(-forward) : forward;
  const Vector3d y = square_to(flat ? kUpward : side, limb).value_or(limb.unitOrthogonal());
  return axes(y.cross(limb), y, limb);
}

Matrix3d between_hands(const Vector3d& x, const Vector3d& limbs, bool level) {
  const auto flat = square_to(x, kUpward);
  if (level && flat) return axes(*flat, kUpward, flat->cross(kUpward));
  const auto forward = square_to(limbs, x);
  const auto up = square_to(kUpward, x);
  const bool by_gravity = up && (level || !forward);
  if (!by_gravity && !forward) {
    const Vector3d y = x.unitOrthogonal();
    return axes(x, y, x.cross(y));
  }
  const Vector3d z = by_gravity ? Vector3d(x.cross(*up)) : *forward;
  return axes(x, z.cross(x), z);
}

PropPose posed(const Vector3d& origin, const Matrix3d& turn) {
  PropPose pose;
  pose.world_from_prop.linear() = turn;
  pose.world_from_prop.translation() = origin;
  return pose;
}

std::optional<PropPose> single_grip(const Skeleton<WorldSpace>& body, const Prop& prop) {
  const Joint& joint = body[prop.joint];
  if (!joint.seen()) return std::nullopt;
  const double sigma = sigma_of(joint);
  if (prop.joint == Head && is_unit(joint.orientation)) {
    PropPose pose = posed(joint.position, joint.orientation.normalized().toRotationMatrix());
    pose.sigma = sigma;
    return pose;
  }
  const auto limb = limb_of(body, prop.joint);
  if (!limb) return std::nullopt;
  PropPose pose = posed(joint.position, along_limb(*limb, ahead(body), prop.level));
  const Joint& from = body[lever_of(prop.joint)];
  const double length = (joint.position - from.position).norm();
  pose.sigma = sigma;
  if (sigma > 0.0)
    pose.turn_sigma =
        std::hypot(std::hypot(sigma, sigma_of(from)) / length, prop.level ? 0.0 : kUnseenTurn);
  return pose;
}

std::optional<PropPose> pair_grip(const Skeleton<WorldSpace>& body, const Prop& prop) {
  const Joint& first = body[prop.joint];
  const Joint& second = body[*prop.other];
  if (!first.seen() || !second.seen()) return std::nullopt;
  const Vector3d line = first.position - second.position;
  if (!(line.norm() > 0.0)) return std::nullopt;
  Vector3d limbs = Vector3d::Zero();
  for (const JointId end : {prop.joint, *prop.other})
    limbs += limb_of(body, end).value_or(Vector3d::Zero());
  PropPose pose = posed(0.5 * (first.position + second.position),
                        between_hands(line.normalized(), limbs, prop.level));
  const double both = std::hypot(sigma_of(first), sigma_of(second));
  pose.sigma = 0.5 * both;
  pose.turn_sigma = both / line.norm();
  return pose;
}

bool named_well(const std::string& name) {
  return !name.empty() && name.size() <= 32 && !name.starts_with("Body") &&
         std::ranges::all_of(name, [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_';
         });
}

void read_vector(ConfigReader& reader, const char* key, Vector3d& out, double most) {
  std::vector<double> values;
  reader.read(key, values);
  if (values.empty()) return;
  if (values.size() != 3) return reader.complain(key, "needs three numbers, in metres");
  out = Vector3d(values[0], values[1], values[2]);
  if (!out.allFinite() || out.cwiseAbs().maxCoeff() > most)
    reader.complain(key, "has a length that no prop has");
}

void read_joints(ConfigReader& reader, Prop& prop) {
  std::vector<std::string> names{std::string(name_of(prop.joint))};
  reader.read("joints", names);
  std::vector<JointId> joints;
  for (const std::string& name : names) {
    const auto found = joint_named(name);
    if (!found) return reader.complain("joints", "'" + name + "' is no joint, as HandRight is one");
    joints.push_back(*found);
  }
  if (joints.empty() || joints.size() > 2 || (joints.size() == 2 && joints[0] == joints[1]))
    return reader.complain("joints", "names one joint, or two that differ");
  prop.joint = joints[0];
  if (joints.size() == 2) prop.other = joints[1];
}

Prop read_prop(ConfigReader reader) {
  constexpr double kLongest = 5.0;  // [m]
  Prop prop;
  reader.read("name", prop.name);
  if (!named_well(prop.name))
    reader.complain("name",
                    "must have 1 to 32 letters, digits, '-' or '_', and not begin with Body");
  read_joints(reader, prop);
  read_vector(reader, "offset_m", prop.offset, kLongest);
  read_vector(reader, "size_m", prop.size, kLongest);
  reader.read_deg("yaw_deg", prop.yaw, -180.0, 180.0);
  reader.read_deg("pitch_deg", prop.pitch, -180.0, 180.0);
  reader.read("level", prop.level);
  return prop;
}

}  // namespace

Eigen::Isometry3d grip_from_prop(const Prop& prop) {
  Eigen::Isometry3d grip = Eigen::Isometry3d::Identity();
  grip.translation() = prop.offset;
  grip.linear() = (Eigen::AngleAxisd(prop.yaw, Vector3d::UnitY()) *
                   Eigen::AngleAxisd(prop.pitch, Vector3d::UnitX()))
                      .toRotationMatrix();
  return grip;
}

JointId lever_of(JointId joint) {
  switch (joint) {
    case WristLeft:
    case HandLeft:
    case HandTipLeft:
    case ThumbLeft:
      return ElbowLeft;
    case WristRight:
    case HandRight:
    case HandTipRight:
    case ThumbRight:
      return ElbowRight;
    case FootLeft:
      return KneeLeft;
    case FootRight:
      return KneeRight;
    case SpineBase:
      return SpineMid;
    default:
      return parent_of(joint);
  }
}

bool well_seen(const Joint& joint) {
  constexpr double kLargest = 0.15;  // [m]; about two widths of a hand
  return joint.seen() && joint.state == JointState::Tracked && sigma_of(joint) < kLargest;
}

std::optional<PropPose> grip_of(const Skeleton<WorldSpace>& body, const Prop& prop) {
  return prop.other ? pair_grip(body, prop) : single_grip(body, prop);
}

std::vector<Prop> read_props(ConfigReader& reader) {
  std::vector<Prop> props;
  std::set<std::string> names;
  for (const ConfigReader& each : reader.items("props")) {
    props.push_back(read_prop(each));
    if (!names.insert(props.back().name).second)
      reader.complain("props", "has '" + props.back().name + "' twice");
  }
  if (props.size() > kMaxProps)
    reader.complain("props", "at most " + std::to_string(kMaxProps) + " are possible");
  return props;
}

}  // namespace chorus::workplace
