#include "services/evaluation/evaluation_resource.h"

#include <array>
#include <string>

#include "common/base/units.h"

namespace chorus::evaluation_service {
namespace {

resource::Decimal degrees(double radians) { return {to_deg(radians), 1}; }

void add_person(resource::Node& node, const std::optional<PersonId>& person) {
  if (person) node.properties.emplace_back("bodyId", static_cast<std::int64_t>(person->value));
}

constexpr int kQuaternionDigits = 4;  ///< 0.01 degrees: for drawing.

void add_axes(resource::Node& node, const LimbAxes& axes) {
  constexpr std::array kTracked{"qx", "qy", "qz", "qw"};
  constexpr std::array kPredicted{"predictedQx", "predictedQy", "predictedQz", "predictedQw"};
  const auto add = [&node](const auto& keys, const Eigen::Quaterniond& q) {
    for (std::size_t i = 0; i < keys.size(); ++i)
      node.properties.emplace_back(
          keys[i], resource::Decimal{q.coeffs()[static_cast<Eigen::Index>(i)], kQuaternionDigits});
  };
  add(kTracked, axes.tracked);
  add(kPredicted, axes.predicted);
}

resource::Node limb_node(const LimbJudgement& limb) {
  resource::Node node{"_", {"LimbEvaluation"}, {}};
  auto& out = node.properties;
  if (limb.limb) out.emplace_back("limb", std::string(inertial::name_of(*limb.limb)));
  out.emplace_back("source", limb.source.str());
  out.emplace_back("inertialSensor", limb.sensor);
  add_person(node, limb.person);
  out.emplace_back("state", std::string(name_of(limb.state)));
  if (limb.error) {
    out.emplace_back("angleDegrees", degrees(limb.error->angle));
    out.emplace_back("swingDegrees", degrees(limb.error->swing));
    if (limb.error->twist_seen) out.emplace_back("twistDegrees", degrees(limb.error->twist));
    out.emplace_back("sigmaDegrees", degrees(limb.sigma));
    out.emplace_back("thresholdDegrees", degrees(limb.tau));
  }
  if (limb.axes) add_axes(node, *limb.axes);
  out.emplace_back("offFor", resource::Decimal{seconds(limb.off_for), 1});
  out.emplace_back("errorSegments", static_cast<std::int64_t>(limb.segments));
  out.emplace_back("comment", words_for(limb));
  return node;
}

resource::Node segment_node(const LimbSegment& each) {
  resource::Node node{"_", {"ErrorSegment"}, {}};
  auto& out = node.properties;
  out.emplace_back("limb", std::string(inertial::name_of(each.limb)));
  out.emplace_back("source", each.source.str());
  out.emplace_back("inertialSensor", each.sensor);
  add_person(node, each.person);
  out.emplace_back("began", each.segment.began);
  if (each.segment.ended) out.emplace_back("ended", *each.segment.ended);
  out.emplace_back("largestDegrees", degrees(each.segment.largest));
  return node;
}

}  // namespace

resource::Node evaluation_node(const EvaluationResource& evaluation) {
  std::vector<resource::Node> limbs;
  for (const LimbJudgement& limb : evaluation.limbs) limbs.push_back(limb_node(limb));
  return {"",
          {"Evaluation"},
          {{"sequence", static_cast<std::int64_t>(evaluation.sequence)},
           {"captured", evaluation.captured},
           {"capturedNanoseconds", to_unix_ns(evaluation.captured)},
           {"tracker", resource::Ref{evaluation.tracker}},
           {"limbs", std::move(limbs)}}};
}

resource::Node segments_node(const std::vector<LimbSegment>& segments) {
  std::vector<resource::Node> nodes;
  for (const LimbSegment& each : segments) nodes.push_back(segment_node(each));
  return {"", {"ErrorSegments"}, {{"segments", std::move(nodes)}}};
}

}  // namespace chorus::evaluation_service
