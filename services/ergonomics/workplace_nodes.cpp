#include "services/ergonomics/workplace_nodes.h"

#include "common/assessment/people.h"
#include "common/base/units.h"
#include "common/workplace/reach.h"
#include "common/workplace/view.h"

namespace chorus::ergonomics_service {
namespace {

using resource::Decimal;
using resource::Node;
using enum JointId;

constexpr int kPlaceDigits = 4;  // 0.1 mm
constexpr int kOddsDigits = 3;

/// The segment that ends in each joint.
constexpr std::array<std::pair<JointId, const char*>, 20> kSegments{{
    {SpineMid, "lowerSpine"},
    {SpineShoulder, "upperSpine"},
    {Neck, "neck"},
    {Head, "head"},
    {ShoulderLeft, "leftShoulder"},
    {ElbowLeft, "leftUpperArm"},
    {WristLeft, "leftForearm"},
    {HandLeft, "leftHand"},
    {ShoulderRight, "rightShoulder"},
    {ElbowRight, "rightUpperArm"},
    {WristRight, "rightForearm"},
    {HandRight, "rightHand"},
    {HipLeft, "leftHip"},
    {KneeLeft, "leftThigh"},
    {AnkleLeft, "leftShank"},
    {FootLeft, "leftFoot"},
    {HipRight, "rightHip"},
    {KneeRight, "rightThigh"},
    {AnkleRight, "rightShank"},
    {FootRight, "rightFoot"},
}};

BoneLengthOf bones_of(const resource::BodyResource& body) {
  BoneLengthOf bones{};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const resource::JointResource& joint = body.joints[j];
    if (joint.bone_length && joint.bone_sigma) bones[j] = {*joint.bone_length, *joint.bone_sigma};
  }
  return bones;
}

Node reach_node(const workplace::ScenePoint& point, bool left, const workplace::Reach& reach) {
  Node node{"_",
            {"Reach"},
            {{"targetName", point.name}, {"handSide", std::string(left ? "left" : "right")}}};
  if (!reach.known) return node;
  node.properties.insert(node.properties.end(),
                         {{"handDistance", Decimal{reach.distance, kPlaceDigits}},
                          {"armMissing", Decimal{reach.arm.missing, kPlaceDigits}},
                          {"reachSigma", Decimal{reach.arm.sigma, kPlaceDigits}},
                          {"armProbability", Decimal{reach.arm.probability, kOddsDigits}},
                          {"leaningMissing", Decimal{reach.leaning.missing, kPlaceDigits}},
                          {"leaningProbability", Decimal{reach.leaning.probability, kOddsDigits}}});
  if (!reach.blocked_by.empty()) node.properties.emplace_back("blockedBy", reach.blocked_by);
  return node;
}

Node sight_node(const std::string& name, const workplace::Seen& seen) {
  Node node{"_",
            {"Sight"},
            {{"sightName", name},
             {"viewAngleDegrees", Decimal{to_deg(seen.angle), 1}},
             {"viewProbability", Decimal{seen.probability, kOddsDigits}}}};
  if (!seen.hidden_by.empty()) node.properties.emplace_back("hiddenBy", seen.hidden_by);
  return node;
}

}  // namespace

Node size_node(const resource::BodyResource& body, std::optional<double> weight_kg) {
  Node node{"", {"BodySize"}, {{"bodyId", static_cast<std::int64_t>(body.id)}}};
  if (body.stature) node.properties.emplace_back("stature", Decimal{*body.stature, kPlaceDigits});
  if (body.stature_sigma)
    node.properties.emplace_back("statureSigma", Decimal{*body.stature_sigma, kPlaceDigits});
  if (weight_kg) node.properties.emplace_back("weightKg", Decimal{*weight_kg, 1});
  const BoneLengthOf bones = bones_of(body);
  std::vector<Node> segments;
  for (const auto& [end, name] : kSegments) {
    const LearnedLength& learned = bones[index_of(end)];
    if (!(learned.sigma > 0.0)) continue;
    segments.push_back({"_",
                        {"Segment"},
                        {{"segmentName", std::string(name)},
                         {"segmentLength", Decimal{learned.length, kPlaceDigits}},
                         {"segmentSigma", Decimal{learned.sigma, kPlaceDigits}}}});
  }
  node.properties.emplace_back("bodySegments", std::move(segments));
  return node;
}

Node workplace_node(const resource::BodyResource& body, const workplace::Scene& scene) {
  const ergonomics::BodyAt person = assessment::body_at(body, body.captured);
  const BoneLengthOf bones = bones_of(body);
  std::vector<Node> reaches;
  for (const workplace::ScenePoint& point : scene.points) {
    for (const bool left : {true, false})
      reaches.push_back(
          reach_node(point, left, reach_of({person.body, left, &bones}, point.at, scene)));
  }
  const workplace::Gaze gaze =
      workplace::gaze_of(person.body, body.joints[index_of(Head)].orientation_covariance);
  std::vector<Node> sights;
  if (gaze.known) {
    for (const workplace::ScenePoint& point : scene.points)
      sights.push_back(sight_node(point.name, sight_of(gaze, point.at, scene)));
    for (const workplace::SceneBox& box : scene.boxes) {
      if (!box.obstacle) sights.push_back(sight_node(box.name, sight_of(gaze, box.centre, scene)));
    }
  }
  Node node{"",
            {"WorkplaceView"},
            {{"bodyId", static_cast<std::int64_t>(body.id)},
             {"captured", body.captured},
             {"sceneTitle", scene.title}}};
  if (gaze.known) node.properties.emplace_back("gazeAssumed", gaze.assumed);
  node.properties.emplace_back("reaches", std::move(reaches));
  node.properties.emplace_back("sights", std::move(sights));
  return node;
}

}  // namespace chorus::ergonomics_service
