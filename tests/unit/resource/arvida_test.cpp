// Profile "arvida": what a client finds when it follows the published pattern, step by step.
#include <map>

#include <gtest/gtest.h>

#include "common/body/bones.h"
#include "common/rdf/turtle_reader.h"
#include "common/resource/decimal_reader.h"
#include "common/resource/frame_resource.h"
#include "tests/support/graph/isomorphism.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

using rdf::Term;

const std::string kSpatial = "http://vocab.arvida.de/2015/06/spatial/vocab#";
const std::string kMaths = "http://vocab.arvida.de/2015/06/maths/vocab#";
const std::string kVom = "http://vocab.arvida.de/2015/06/vom/vocab#";
const std::string kSkel = "http://vocab.arvida.de/2015/05/skel/vocab#";
const std::string kCore = "http://vocab.arvida.de/2015/06/core/vocab#";

/// A graph for following properties from node to node.
class Walk {
 public:
  explicit Walk(const FrameResource& frame, Place place = {"frame", "", "http://h/"}) {
    rdf::ReadOptions options;
    options.base = place.root + place.path;
    const auto graph = rdf::read_graph(write_arvida(frame, place), options);
    EXPECT_TRUE(graph) << to_string(graph.error());
    for (const rdf::Triple& triple : graph.value_or(rdf::Graph{})) {
      objects_[{triple.subject, triple.predicate.value}].push_back(triple.object);
    }
  }
  [[nodiscard]] std::vector<Term> all(const Term& from, const std::string& verb) const {
    const auto found = objects_.find({from, verb});
    return found == objects_.end() ? std::vector<Term>{} : found->second;
  }
  /// The single object; an empty term when there is none, or more than one.
  [[nodiscard]] Term one(const Term& from, const std::string& verb) const {
    const auto found = all(from, verb);
    return found.size() == 1 ? found.front() : Term{};
  }
  [[nodiscard]] bool is_a(const Term& from, const std::string& type) const {
    const auto types = all(from, rdf::rdf("type"));
    return std::find(types.begin(), types.end(), rdf::iri(type)) != types.end();
  }
  [[nodiscard]] double number(const Term& from, const std::string& verb) const {
    return read_decimal(one(from, verb).value).value_or(std::nan(""));
  }

 private:
  std::map<std::pair<Term, std::string>, std::vector<Term>> objects_;
};

Term joint_of(const FrameResource& frame, std::size_t body, std::size_t joint) {
  return rdf::iri("http://h/skeletons/" + std::to_string(frame.bodies[body].id) + "#" +
                  std::string(kJointNames[joint]));
}

TEST(Arvida, TheFrameIsAContainerOfItsSkeletons) {
  const FrameResource frame = random_frame(4, {3, false});
  const Walk walk(frame);
  const Term root = rdf::iri("http://h/frame");
  EXPECT_TRUE(walk.is_a(root, kCore + "Container"));
  EXPECT_EQ(walk.all(root, kCore + "member").size(), 3U);
  for (const Term& member : walk.all(root, kCore + "member")) {
    EXPECT_TRUE(walk.is_a(member, kSkel + "Skeleton"));
    EXPECT_EQ(walk.all(member, kSkel + "skeletonJoint").size(), kJointCount);
  }
  const Term space = rdf::iri("http://h/frame#space");
  EXPECT_TRUE(walk.is_a(space, kMaths + "RightHandedCartesianCoordinateSystem3D"));
  EXPECT_EQ(walk.one(space, kMaths + "axesUnit").value, kVom + "meter");
}

TEST(Arvida, EveryJointIsARelationFromTheSpaceToItself) {
  const FrameResource frame = random_frame(4, {2, false});
  const Walk walk(frame);
  for (std::size_t body = 0; body < 2; ++body) {
    for (std::size_t i = 0; i < kJointCount; ++i) {
      const Term joint = joint_of(frame, body, i);
      EXPECT_TRUE(walk.is_a(joint, kSpatial + "SpatialRelationship")) << joint.value;
      EXPECT_EQ(walk.one(joint, kSpatial + "spatialRelationship"), joint);
      EXPECT_EQ(walk.one(joint, kSpatial + "sourceCoordinateSystem").value, "http://h/frame#space");
      const Term target = walk.one(joint, kSpatial + "targetCoordinateSystem");
      EXPECT_TRUE(walk.is_a(target, kMaths + "RightHandedCartesianCoordinateSystem3D"));
      const Term stamp = walk.one(walk.one(joint, kSpatial + "timestamp"), kVom + "quantityValue");
      EXPECT_EQ(walk.one(stamp, kVom + "numericalValue").value,
                std::to_string(to_unix_ns(frame.bodies[body].captured)));
      EXPECT_EQ(walk.one(stamp, kVom + "unit").value, kVom + "NanoSecond");
    }
  }
}

TEST(Arvida, TranslationsAreTheJointsPlacesInMetres) {
  const FrameResource frame = random_frame(6, {1, false});
  const Walk walk(frame);
  int seen = 0;
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Term translation = walk.one(joint_of(frame, 0, i), kSpatial + "translation");
    const JointResource& joint = frame.bodies[0].joints[i];
    const bool point =
        joint.state != JointState::NotTracked && joint.measurement == Measurement::Point;
    EXPECT_EQ(!translation.value.empty(), point) << "a ray has no place";
    if (translation.value.empty()) continue;
    const Term vector = walk.one(translation, kVom + "quantityValue");
    EXPECT_NEAR(walk.number(vector, kMaths + "x"), joint.position.x(), 1e-9);
    EXPECT_NEAR(walk.number(vector, kMaths + "y"), joint.position.y(), 1e-9);
    EXPECT_NEAR(walk.number(vector, kMaths + "z"), joint.position.z(), 1e-9);
    EXPECT_EQ(walk.one(vector, kVom + "unit").value, kVom + "meter");
    ++seen;
  }
  EXPECT_GT(seen, 10);
}

TEST(Arvida, RotationsStandWhereTheSensorGivesThem) {
  const FrameResource frame = random_frame(6, {1, false});
  const Walk walk(frame);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const JointResource& joint = frame.bodies[0].joints[i];
    const bool given = joint.state != JointState::NotTracked && joint.orientation.norm() > 0;
    EXPECT_EQ(walk.all(joint_of(frame, 0, i), kSpatial + "rotation").size(), given ? 1U : 0U);
  }
}

TEST(Arvida, NTriplesIsTheSameGraph) {
  const FrameResource frame = random_frame(9, {2, true});
  const Place place{"frames/42", "", "http://h/"};
  rdf::ReadOptions options;
  options.base = "http://h/frames/42";
  const auto turtle = rdf::read_graph(write_arvida(frame, place), options);
  const auto triples = rdf::read_graph(write_arvida(frame, place, Format::NTriples),
                                       {rdf::Syntax::NTriples, {}, {}});
  ASSERT_TRUE(turtle && triples);
  EXPECT_EQ(testing::difference(*turtle, *triples), "");
}

TEST(Arvida, AnEmptyFrameAndAFullOneAreBothWhole) {
  EXPECT_TRUE(rdf::read_graph(write_arvida(random_frame(1, {0, false}))));
  const auto full = rdf::read_graph(write_arvida(random_frame(1, {kMaxBodies, true})),
                                    {rdf::Syntax::Turtle, {}, {.bytes = 20'000'000}});
  ASSERT_TRUE(full) << to_string(full.error());
  EXPECT_GT(full->size(), kMaxBodies * kJointCount * 15);
}

}  // namespace
}  // namespace chorus::resource
