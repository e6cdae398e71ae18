#include "tests/unit/resource/frames.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "common/body/bones.h"

namespace chorus::resource {
namespace {

using rdf::Graph;
using rdf::Term;

double rounded(double value, double unit) { return std::round(value / unit) * unit; }

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed) {}
  double between(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  bool chance(double p) { return between(0, 1) < p; }
  std::uint64_t number(std::uint64_t most) {
    return std::uniform_int_distribution<std::uint64_t>(0, most)(random_);
  }

 private:
  std::mt19937_64 random_;
};

/// A position; in a sensor's frame sometimes only a direction.
Eigen::Vector3d random_position(Dice& dice, JointResource& joint, const FrameResource& frame) {
  Eigen::Vector3d p;
  for (int i = 0; i < 3; ++i) p[i] = rounded(dice.between(-5, 5), 1e-4);
  if (!frame.sensors.empty() || dice.chance(0.8)) return p;
  joint.measurement = Measurement::Ray;
  p.normalize();
  for (int i = 0; i < 3; ++i) p[i] = rounded(p[i], 1e-6);
  return p;
}

Eigen::Vector3d random_velocity(Dice& dice) {
  Eigen::Vector3d v;
  for (int i = 0; i < 3; ++i) v[i] = rounded(dice.between(-3, 3), 1e-4);
  return v;
}

Covariance random_covariance(Dice& dice) {
  Eigen::Matrix3d root;
  for (int i = 0; i < 9; ++i) root(i) = dice.between(-0.05, 0.05);
  Eigen::Matrix3d full = root * root.transpose() + 1e-5 * Eigen::Matrix3d::Identity();
  for (int i = 0; i < 9; ++i) full(i) = rounded(full(i), 1e-8);
  return Covariance(full);
}

Shares random_shares(Dice& dice, std::uint64_t contributors) {
  ShareTally tally;
  for (std::uint64_t bit = 1; bit != 0 && bit <= contributors; bit <<= 1U)
    tally.add(contributors & bit, dice.between(0, 1));
  return tally.shares();
}

HandPoints random_hand(Dice& dice) {
  HandPoints hand;
  for (Eigen::Vector3d& point : hand.points)
    for (int i = 0; i < 3; ++i) point[i] = rounded(dice.between(-5, 5), 1e-4);
  if (dice.chance(0.5)) hand.variance = rounded(dice.between(0, 0.01), 1e-8);
  return hand;
}

PropResource random_prop(Dice& dice, std::string name) {
  PropResource prop{std::move(name)};
  for (int i = 0; i < 3; ++i) prop.position[i] = rounded(dice.between(-5, 5), 1e-4);
  // of length one although it has five decimals
  prop.orientation = dice.chance(0.5) ? Eigen::Quaterniond(0.6, 0.0, -0.8, 0.0)
                                      : Eigen::Quaterniond(0.0, 0.28, 0.0, 0.96);
  if (dice.chance(0.7)) prop.holder = dice.number(1'000);
  if (dice.chance(0.7)) prop.place_sigma = rounded(dice.between(0, 0.3), 1e-4);
  if (dice.chance(0.7)) prop.turn_sigma_degrees = rounded(dice.between(0, 40), 0.1);
  return prop;
}

JointResource random_joint(Dice& dice, const FrameResource& frame) {
  JointResource joint;
  if (dice.chance(0.2)) return joint;
  joint.state = dice.chance(0.3) ? JointState::Inferred : JointState::Tracked;
  joint.position = random_position(dice, joint, frame);
  if (dice.chance(0.9)) {
    Eigen::Quaterniond q(dice.between(-1, 1), dice.between(-1, 1), dice.between(-1, 1),
                         dice.between(0.1, 1));
    q.normalize();
    for (int i = 0; i < 4; ++i) joint.orientation.coeffs()[i] = rounded(q.coeffs()[i], 1e-5);
  }
  if (dice.chance(0.4)) joint.covariance = random_covariance(dice);
  if (frame.sensors.empty()) return joint;
  joint.variance = rounded(dice.between(0, 0.01), 1e-8);
  joint.contributors = dice.number((std::uint64_t{1} << frame.sensors.size()) - 1);
  if (joint.contributors == 0 && dice.chance(0.8)) joint.age = rounded(dice.between(0, 3), 1e-3);
  if (dice.chance(0.7)) {
    joint.velocity = random_velocity(dice);
    joint.velocity_variance = rounded(dice.between(0, 0.1), 1e-6);
    if (dice.chance(0.5)) joint.orientation_covariance = random_covariance(dice);
    joint.bone_length = rounded(dice.between(0, 0.5), 1e-4);
    joint.bone_sigma = rounded(dice.between(0, 0.1), 1e-4);
  }
  const bool shared = std::popcount(joint.contributors) == 1 || dice.chance(0.8);
  if (shared) joint.shares = random_shares(dice, joint.contributors);
  return joint;
}

/// Adds triples with the same subject.
struct About {
  Graph& graph;
  Term subject;

  void type(const std::string& name) {
    graph.push_back({subject, rdf::iri(rdf::rdf("type")), own(name)});
  }
  void say(const std::string& property, Term object) {
    graph.push_back({subject, own(property), std::move(object)});
  }
  void integer(const std::string& property, const std::string& value) {
    say(property, rdf::literal(value, rdf::xsd("integer")));
  }
  void decimal(const std::string& property, double value, int digits) {
    say(property, rdf::literal(decimals(value, digits), rdf::xsd("decimal")));
  }
  void times(Timestamp captured) {
    say("captured", rdf::literal(to_iso8601(captured), rdf::xsd("dateTime")));
    integer("capturedNanoseconds", std::to_string(to_unix_ns(captured)));
  }
  static Term own(const std::string& name) {
    return rdf::iri("https://w3id.org/chorus-tracking/ns#" + name);
  }
};

void add_list(About& about, const std::string& property, const std::vector<double>& values,
              int digits) {
  const std::string cell = "list" + std::to_string(about.graph.size()) + "cell";
  about.say(property, rdf::blank(cell + "0"));
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Term here = rdf::blank(cell + std::to_string(i));
    const bool last = i + 1 == values.size();
    const Term next = last ? rdf::iri(rdf::rdf("nil")) : rdf::blank(cell + std::to_string(i + 1));
    about.graph.push_back({here, rdf::iri(rdf::rdf("first")),
                           rdf::literal(decimals(values[i], digits), rdf::xsd("decimal"))});
    about.graph.push_back({here, rdf::iri(rdf::rdf("rest")), next});
  }
}

void add_hand(About& about, const std::string& name, const std::optional<HandPoints>& hand) {
  if (!hand) return;
  std::vector<double> values;
  for (const Eigen::Vector3d& point : hand->points)
    for (int i = 0; i < 3; ++i) values.push_back(point[i]);
  add_list(about, name, values, 4);
  if (hand->variance) about.decimal(name + "Variance", *hand->variance, 8);
}

void add_prop(Graph& graph, const std::string& iri, const PropResource& prop) {
  About about{graph, rdf::iri(iri)};
  about.type("HeldProp");
  about.say("propName", rdf::literal(prop.name));
  if (prop.holder) about.integer("heldBy", std::to_string(*prop.holder));
  constexpr std::array kAxes{"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    about.decimal(kAxes[static_cast<std::size_t>(i)], prop.position[i], 4);
  constexpr std::array kTurns{"qx", "qy", "qz", "qw"};
  for (int i = 0; i < 4; ++i)
    about.decimal(kTurns[static_cast<std::size_t>(i)], prop.orientation.coeffs()[i], 5);
  if (prop.place_sigma) about.decimal("placeSigma", *prop.place_sigma, 4);
  if (prop.turn_sigma_degrees) about.decimal("turnSigmaDegrees", *prop.turn_sigma_degrees, 1);
}

/// An RDF list of the shares, by sensor id, unless one sensor has all.
void add_shares(About& about, const FrameResource& frame, const JointResource& joint) {
  std::map<std::string, double> shares;
  for (std::size_t i = 0; i < frame.sensors.size(); ++i) {
    if ((joint.contributors >> i & 1U) != 0) shares[frame.sensors[i]] = joint.shares.of(i);
  }
  if (!joint.shares.known() || shares.size() < 2) return;
  std::vector<double> values;
  for (const auto& [sensor, share] : shares) values.push_back(share);
  add_list(about, "shares", values, 2);
}

/// Of a joint or a body.
template <class Owner>
void add_velocity(About& about, const Owner& owner) {
  if (owner.velocity) {
    about.decimal("vx", owner.velocity->x(), 4);
    about.decimal("vy", owner.velocity->y(), 4);
    about.decimal("vz", owner.velocity->z(), 4);
  }
  if (owner.velocity_variance) about.decimal("velocityVariance", *owner.velocity_variance, 6);
}

void add_joint(Graph& graph, const FrameResource& frame, const std::string& iri, std::size_t index,
               const JointResource& joint) {
  About about{graph, rdf::iri(iri)};
  about.type("Joint");
  about.say("jointName", rdf::literal(std::string(kJointNames[index])));
  if (joint.state == JointState::NotTracked) return about.say("state", About::own("NotTracked"));
  about.say("state", About::own(joint.state == JointState::Tracked ? "Tracked" : "Inferred"));
  const bool ray = joint.measurement == Measurement::Ray;
  about.decimal(ray ? "rayX" : "x", joint.position.x(), ray ? 6 : 4);
  about.decimal(ray ? "rayY" : "y", joint.position.y(), ray ? 6 : 4);
  about.decimal(ray ? "rayZ" : "z", joint.position.z(), ray ? 6 : 4);
  if (joint.orientation.norm() > 0) {
    about.decimal("qx", joint.orientation.x(), 5);
    about.decimal("qy", joint.orientation.y(), 5);
    about.decimal("qz", joint.orientation.z(), 5);
    about.decimal("qw", joint.orientation.w(), 5);
  }
  if (joint.variance) about.decimal("variance", *joint.variance, 8);
  constexpr std::array kTerms{"cxx", "cxy", "cxz", "cyy", "cyz", "czz"};
  for (std::size_t i = 0; joint.covariance.known() && i < kTerms.size(); ++i)
    about.decimal(kTerms[i], joint.covariance.term(i), 8);
  for (std::size_t i = 0; i < frame.sensors.size(); ++i) {
    if ((joint.contributors >> i & 1U) != 0)
      about.say("contributor", rdf::literal(frame.sensors[i]));
  }
  add_shares(about, frame, joint);
  if (joint.age) about.decimal("age", *joint.age, 3);
  add_velocity(about, joint);
  constexpr std::array kTurns{"oxx", "oxy", "oxz", "oyy", "oyz", "ozz"};
  for (std::size_t i = 0; joint.orientation_covariance.known() && i < kTurns.size(); ++i)
    about.decimal(kTurns[i], joint.orientation_covariance.term(i), 8);
  if (joint.bone_length) about.decimal("boneLength", *joint.bone_length, 4);
  if (joint.bone_sigma) about.decimal("boneSigma", *joint.bone_sigma, 4);
}

}  // namespace

FrameResource random_frame(std::uint64_t seed, const FrameKind& kind) {
  Dice dice(seed);
  FrameResource frame;
  frame.sequence = dice.number(1'000'000);
  frame.captured = from_unix_ns(1'795'246'200'000'000'000 +
                                static_cast<std::int64_t>(dice.number(1'000'000'000'000)));
  frame.source = kind.fused ? "fusion" : "s1";
  frame.space = kind.fused ? SpaceKind::World : SpaceKind::Sensor;
  if (kind.fused) frame.registration_version = dice.number(1'000);
  if (kind.fused) frame.sensors = {"s1", "s2", "s10", "north_3"};
  for (std::size_t b = 0; b < kind.bodies; ++b) {
    BodyResource body;
    body.id = b * 1'000 + dice.number(999);
    if (kind.fused && b != 2) body.slot = kind.bodies - 1 - b;  // body 2 has no slot
    if (kind.fused && b != 1) body.sides_confidence = rounded(dice.between(0, 1), 1e-4);
    if (kind.fused && b == 1) body.carried_for = rounded(dice.between(0, 3), 1e-3);
    if (kind.fused && b == 2) body.smoothed_over = rounded(dice.between(0, 3), 1e-3);
    if (kind.fused && b != 2) body.velocity = random_velocity(dice);
    if (kind.fused && b != 2) body.velocity_variance = rounded(dice.between(0, 0.1), 1e-6);
    if (kind.fused && b != 1) body.stature = rounded(dice.between(1, 2), 1e-4);
    if (kind.fused && b != 1) body.stature_sigma = rounded(dice.between(0, 0.1), 1e-4);
    if (kind.fused && b != 2) body.method = "body-filter";
    if (b == 1) body.id = 72'057'594'037'928'018;  // like Kinect v2 ids: too large for a double
    body.captured =
        dice.chance(0.5) ? frame.captured : frame.captured - Duration(dice.number(30'000'000));
    for (JointResource& joint : body.joints) joint = random_joint(dice, frame);
    if (dice.chance(0.3)) body.left_hand = random_hand(dice);
    if (dice.chance(0.3)) body.right_hand = random_hand(dice);
    frame.bodies.push_back(body);
  }
  if (kind.fused && dice.chance(0.5)) frame.props.push_back(random_prop(dice, "box"));
  if (kind.fused && dice.chance(0.3)) frame.props.push_back(random_prop(dice, "screw-driver_2"));
  return frame;
}

rdf::Graph expected_graph(const FrameResource& frame) {
  Graph graph;
  const std::string own = "frames/" + std::to_string(frame.sequence);
  About about{graph, rdf::iri(own)};
  about.type("Frame");
  about.integer("sequence", std::to_string(frame.sequence));
  about.times(frame.captured);
  about.say("source", rdf::literal(frame.source));
  about.say("space", About::own(frame.space == SpaceKind::World ? "WorldSpace" : "SensorSpace"));
  if (frame.registration_version)
    about.integer("registrationVersion", std::to_string(*frame.registration_version));
  for (const std::string& sensor : frame.sensors) about.say("sensor", rdf::literal(sensor));
  for (const BodyResource& body : frame.bodies) {
    const std::string iri = own + "#" + std::to_string(body.id);
    about.say("body", rdf::iri(iri));
    About skeleton{graph, rdf::iri(iri)};
    skeleton.type("Skeleton");
    skeleton.say("of", rdf::iri("skeletons/" + std::to_string(body.id)));
    skeleton.integer("bodyId", std::to_string(body.id));
    if (body.slot) skeleton.integer("slot", std::to_string(*body.slot));
    if (body.sides_confidence) skeleton.decimal("sidesConfidence", *body.sides_confidence, 4);
    if (body.carried_for) skeleton.decimal("carriedFor", *body.carried_for, 3);
    if (body.smoothed_over) skeleton.decimal("smoothedOver", *body.smoothed_over, 3);
    add_velocity(skeleton, body);
    if (body.method) skeleton.say("fusionMethod", rdf::literal(*body.method));
    if (body.stature) skeleton.decimal("stature", *body.stature, 4);
    if (body.stature_sigma) skeleton.decimal("statureSigma", *body.stature_sigma, 4);
    add_hand(skeleton, "leftHand", body.left_hand);
    add_hand(skeleton, "rightHand", body.right_hand);
    skeleton.times(body.captured);
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const std::string joint = iri + "-" + std::string(kJointNames[i]);
      skeleton.say("joint", rdf::iri(joint));
      add_joint(graph, frame, joint, i, body.joints[i]);
    }
  }
  for (const PropResource& prop : frame.props) {
    about.say("heldProp", rdf::iri(own + "#prop-" + prop.name));
    add_prop(graph, own + "#prop-" + prop.name, prop);
  }
  return graph;
}

}  // namespace chorus::resource
