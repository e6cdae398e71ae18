#include <cmath>
#include <cstdio>

#include "common/body/bones.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

/// True if both are missing, or equal except for the last bits, which decimals do not preserve.
bool same(const std::optional<double>& a, const std::optional<double>& b) {
  return a.has_value() == b.has_value() && std::abs(a.value_or(0.0) - b.value_or(0.0)) < 1e-9;
}

template <class Owner>
std::string velocity_of(const Owner& owner) {
  if (!owner.velocity) return " still";
  std::string text;
  for (int i = 0; i < 3; ++i) text += " " + decimals((*owner.velocity)[i], 4);
  return text + " " + decimals(owner.velocity_variance.value_or(-1), 6);
}

std::string text_of(const JointResource& joint) {
  std::string text = std::to_string(static_cast<int>(joint.state));
  for (int i = 0; i < 3; ++i) text += " " + decimals(joint.position[i], 6);
  for (int i = 0; i < 4; ++i) text += " " + decimals(joint.orientation.coeffs()[i], 7);
  text += joint.measurement == Measurement::Ray ? " ray" : " point";
  for (std::size_t i = 0; joint.covariance.known() && i < Covariance::kTerms; ++i)
    text += " " + decimals(joint.covariance.term(i), 8);
  for (std::size_t i = 0; joint.orientation_covariance.known() && i < Covariance::kTerms; ++i)
    text += " o" + decimals(joint.orientation_covariance.term(i), 8);
  std::string shares = joint.shares.known() ? " s" : "";
  for (std::size_t i = 0; joint.shares.known() && i < kMaxSensors; ++i)
    shares += " " + decimals(joint.shares.of(i), 4);
  return text + " v" + decimals(joint.variance.value_or(-1), 10) + " c" +
         std::to_string(joint.contributors) + shares + " a" + decimals(joint.age.value_or(-1), 6) +
         velocity_of(joint) + " b" + decimals(joint.bone_length.value_or(-1), 4) +
         decimals(joint.bone_sigma.value_or(-1), 4);
}

std::string text_of(const std::optional<HandPoints>& hand) {
  if (!hand) return "none";
  std::string text = decimals(hand->variance.value_or(-1), 8);
  for (const Eigen::Vector3d& point : hand->points)
    for (int i = 0; i < 3; ++i) text += " " + decimals(point[i], 6);
  return text;
}

std::string text_of(const PropResource& prop) {
  std::string text = prop.name + " " + (prop.holder ? std::to_string(*prop.holder) : "-");
  for (int i = 0; i < 3; ++i) text += " " + decimals(prop.position[i], 6);
  for (int i = 0; i < 4; ++i) text += " " + decimals(prop.orientation.coeffs()[i], 7);
  return text + " " + decimals(prop.place_sigma.value_or(-1), 6) + " " +
         decimals(prop.turn_sigma_degrees.value_or(-1), 3);
}

}  // namespace

std::string decimals(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value == 0.0 ? 0.0 : value);
  return text;
}

std::string difference(const FrameResource& a, const FrameResource& b) {
  if (a.sequence != b.sequence) return "sequence";
  if (a.captured != b.captured) return "captured";
  if (a.source != b.source) return "source";
  if (a.space != b.space) return "space";
  if (a.sensors != b.sensors) return "sensors";
  if (a.registration_version != b.registration_version) return "version of the registration";
  if (a.bodies.size() != b.bodies.size()) return "number of bodies";
  for (std::size_t i = 0; i < a.bodies.size(); ++i) {
    if (a.bodies[i].id != b.bodies[i].id) return "body id";
    if (a.bodies[i].slot != b.bodies[i].slot) return "slot";
    if (!same(a.bodies[i].sides_confidence, b.bodies[i].sides_confidence))
      return "confidence of sides";
    if (!same(a.bodies[i].carried_for, b.bodies[i].carried_for)) return "carried for";
    if (!same(a.bodies[i].smoothed_over, b.bodies[i].smoothed_over)) return "smoothed over";
    if (!same(a.bodies[i].stature, b.bodies[i].stature) ||
        !same(a.bodies[i].stature_sigma, b.bodies[i].stature_sigma))
      return "stature";
    if (a.bodies[i].method != b.bodies[i].method) return "method";
    if (velocity_of(a.bodies[i]) != velocity_of(b.bodies[i])) return "velocity of a body";
    if (a.bodies[i].captured != b.bodies[i].captured) return "body captured";
    if (text_of(a.bodies[i].left_hand) != text_of(b.bodies[i].left_hand)) return "left hand";
    if (text_of(a.bodies[i].right_hand) != text_of(b.bodies[i].right_hand)) return "right hand";
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const std::string left = text_of(a.bodies[i].joints[j]);
      const std::string right = text_of(b.bodies[i].joints[j]);
      if (left != right) return std::string(kJointNames[j]) + ": " + left + " | " + right;
    }
  }
  if (a.props.size() != b.props.size()) return "number of props";
  for (std::size_t i = 0; i < a.props.size(); ++i)
    if (text_of(a.props[i]) != text_of(b.props[i]))
      return text_of(a.props[i]) + " | " + text_of(b.props[i]);
  return {};
}

}  // namespace chorus::resource
