#include "common/resource/frame_document.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "common/body/bones.h"
#include "common/rdf/turtle_reader.h"
#include "tests/support/graph/isomorphism.h"
#include "tests/unit/resource/frames.h"

namespace chorus::resource {
namespace {

std::string body_of(const http::DocumentPtr& document, std::string_view accept,
                    std::string_view profile = "") {
  const auto chosen = document->choose(accept, profile);
  EXPECT_TRUE(chosen) << to_string(chosen.error());
  return chosen ? std::string((*chosen)->body()) : std::string();
}

rdf::Graph graph_at(const std::string& text, const std::string& base,
                    rdf::Syntax syntax = rdf::Syntax::Turtle) {
  const auto graph = rdf::read_graph(text, {syntax, base, {}});
  EXPECT_TRUE(graph) << to_string(graph.error());
  return graph.value_or(rdf::Graph{});
}

TEST(FrameDocument, OffersEveryFormatAndTheArvidaProfile) {
  const auto frame = std::make_shared<const FrameResource>(random_frame(1, {2, true}));
  const auto document = frame_document(frame, {"frame"}, latest_options(*frame));
  EXPECT_EQ(body_of(document, ""), write(*frame, Format::Turtle, {"frame"}))
      << "Turtle when not asked";
  EXPECT_EQ(body_of(document, "application/json"), write(*frame, Format::Json, {"frame"}));
  EXPECT_EQ(body_of(document, "application/ld+json"), write(*frame, Format::JsonLd, {"frame"}));
  EXPECT_EQ(body_of(document, "application/n-triples"), write(*frame, Format::NTriples, {"frame"}));
  EXPECT_EQ(body_of(document, "", "arvida"), write_arvida(*frame, {"frame"}));
  EXPECT_FALSE(body_of(document, "application/n-triples", "arvida").empty());
  EXPECT_FALSE(document->choose("application/json", "arvida"));
  EXPECT_FALSE(document->choose("", "unknown"));
}

TEST(FrameDocument, TheLeanFormHasPlaceAndStateOfEveryJointUnderTheSameKeys) {
  const auto frame = std::make_shared<const FrameResource>(random_frame(3, {4, true}));
  const auto document = frame_document(frame, {"frame"}, latest_options(*frame));
  const auto full = nlohmann::json::parse(body_of(document, "application/json"));
  const auto lean = nlohmann::json::parse(body_of(document, "application/json", "pose"));
  for (const char* key : {"sequence", "captured", "capturedNanoseconds", "source", "space"})
    EXPECT_EQ(lean.at(key), full.at(key)) << key;
  ASSERT_EQ(lean.at("bodies").size(), full.at("bodies").size());
  for (std::size_t i = 0; i < lean.at("bodies").size(); ++i) {
    const auto& a = lean.at("bodies")[i];
    const auto& b = full.at("bodies")[i];
    EXPECT_EQ(a.at("bodyId"), b.at("bodyId"));
    EXPECT_EQ(a.value("slot", -1), b.value("slot", -1));
    ASSERT_EQ(a.at("joints").size(), kJointCount);
    for (const auto& [name, joint] : b.at("joints").items()) {
      const auto& own = a.at("joints").at(name);
      EXPECT_EQ(own.at("state"), joint.at("state"));
      EXPECT_EQ(own.contains("x"), joint.contains("x"));
      if (joint.contains("x")) {
        EXPECT_NEAR(own.at("y"), joint.at("y"), 0.00056) << name;
      }
      EXPECT_LE(own.size(), 4u) << "nothing else";
    }
  }
  EXPECT_FALSE(document->choose("text/turtle", "pose")) << "in JSON only";
  EXPECT_NE(document->event("application/json", "pose"), nullptr);
}

TEST(FrameDocument, TheLeanFormOfNobodyAndOfRays) {
  FrameResource frame;
  EXPECT_EQ(nlohmann::json::parse(write_pose(frame)).at("bodies").size(), 0u);
  frame.bodies.resize(2);
  frame.bodies[1].id = ~std::uint64_t{0};
  Joint& head = frame.bodies[1].joints[index_of(JointId::Head)];
  head.state = JointState::Tracked;
  head.measurement = Measurement::Ray;
  head.position = {0.0, 0.0, 1.0};
  frame.bodies[1].joints[0].state = JointState::Tracked;
  frame.bodies[1].joints[0].position.x() = std::numeric_limits<double>::quiet_NaN();
  const auto lean = nlohmann::json::parse(write_pose(frame));
  EXPECT_EQ(lean.at("bodies")[1].at("bodyId"), "18446744073709551615");
  EXPECT_EQ(lean.at("bodies")[1].at("joints").at("Head").at("rayZ"), 1.0);
  EXPECT_EQ(lean.at("bodies")[1].at("joints").at("SpineBase").at("state"), "NotTracked");
}

TEST(FrameDocument, TheLatestFrameNamesItsImmutableTwin) {
  const auto frame = std::make_shared<const FrameResource>(random_frame(1));
  const std::string sequence = std::to_string(frame->sequence);
  const auto latest = frame_document(frame, {"frame"}, latest_options(*frame));
  EXPECT_EQ(latest->options().version, sequence);
  EXPECT_EQ(latest->options().content_location, "frames/" + sequence);
  EXPECT_EQ(latest->options().cache_control, "no-cache");
  const auto kept = frame_document(frame, {"frames/" + sequence}, kept_options(*frame));
  EXPECT_NE(kept->options().cache_control.find("immutable"), std::string::npos);
  EXPECT_TRUE(kept->options().content_location.empty());
  EXPECT_EQ(latest->options().captured, frame->captured);
  EXPECT_EQ(kept->options().captured, std::nullopt) << "the age of an old frame is of no use";
  EXPECT_EQ(latest_options(*frame, "r1").version, sequence + ".r1");
}

TEST(FrameDocument, BothPlacesSpeakOfTheSameResources) {
  const auto frame = std::make_shared<const FrameResource>(random_frame(1, {1, false}));
  const auto at_root =
      graph_at(body_of(frame_document(frame, {"frame"}, {}), ""), "http://h/frame");
  const auto below =
      graph_at(body_of(frame_document(frame, {"frames/1"}, {}), ""), "http://h/frames/1");
  EXPECT_EQ(testing::difference(at_root, below), "");
}

TEST(SkeletonDocument, IsOneBodyInEveryFormat) {
  const auto frame = std::make_shared<const FrameResource>(random_frame(1, {2, true}));
  const std::string id = std::to_string(frame->bodies[1].id);
  const Place place{"skeletons/" + id, "", "http://h/"};
  const auto document =
      skeleton_document(frame, frame->bodies[1].id, place, latest_options(*frame));
  ASSERT_NE(document, nullptr);
  const std::string base = "http://h/skeletons/" + id;
  const auto turtle = graph_at(body_of(document, "text/turtle"), base);
  const auto triples =
      graph_at(body_of(document, "application/n-triples"), "", rdf::Syntax::NTriples);
  EXPECT_EQ(testing::difference(turtle, triples), "");
  EXPECT_EQ(turtle.front().subject.value, base) << "the document speaks of itself first";
  const auto json = nlohmann::json::parse(body_of(document, "application/json"));
  EXPECT_EQ(json.at("@type"), "Skeleton");
  EXPECT_EQ(json.at("frame"), "../frame");
  EXPECT_EQ(json.at("space"), "WorldSpace");
  EXPECT_EQ(json.at("joints").size(), kJointCount);
  EXPECT_EQ(nlohmann::json::parse(body_of(document, "application/ld+json")).at("@context"),
            "../context.jsonld");
}

/// Number of different positions that the documents together state for one joint of one body.
std::size_t places_of(const rdf::Graph& all, const std::string& joint) {
  const rdf::Term x = rdf::iri("https://w3id.org/chorus-tracking/ns#x");
  std::set<std::string> places;
  for (const rdf::Triple& triple : all) {
    if (triple.subject.value == joint && triple.predicate == x) places.insert(triple.object.value);
  }
  return places.size();
}

TEST(FrameDocument, AnyNumberOfThemStayTrueTogether) {
  rdf::Graph all;
  std::set<std::string> heads;
  for (std::uint64_t i = 0; i < 100; ++i) {
    auto frame = std::make_shared<FrameResource>(random_frame(7, {1, true}));
    frame->sequence = i;
    JointResource& head = frame->bodies[0].joints[index_of(JointId::Head)];
    head.position = {static_cast<double>(i), 0, 0};
    head.state = JointState::Tracked;
    head.measurement = Measurement::Point;
    const std::string id = std::to_string(frame->bodies[0].id);
    for (const auto& [text, base] :
         {std::pair{write(*frame, Format::Turtle, {"frame"}), std::string("http://h/frame")},
          {write_skeleton(*frame, frame->bodies[0], Format::Turtle, {"skeletons/" + id}),
           "http://h/skeletons/" + id}}) {
      for (rdf::Triple& triple : graph_at(text, base)) all.push_back(std::move(triple));
    }
    heads.insert("http://h/frames/" + std::to_string(i) + "#" + id + "-Head");
  }
  EXPECT_EQ(heads.size(), 100U);
  for (const std::string& head : heads) EXPECT_EQ(places_of(all, head), 1U) << head;
  const rdf::Term x = rdf::iri("https://w3id.org/chorus-tracking/ns#x");
  for (const rdf::Triple& triple : all) {
    if (triple.predicate != x) continue;
    EXPECT_NE(triple.subject.value.find("/frames/"), std::string::npos)
        << triple.subject.value << " lives on and has no place of its own";
  }
}

TEST(SkeletonDocument, ThereIsNoneForABodyThatIsNotThere) {
  const auto frame = std::make_shared<const FrameResource>(random_frame(1));
  EXPECT_EQ(skeleton_document(frame, 12'345'678, {"skeletons/12345678"}, {}), nullptr);
}

TEST(SkeletonsDocument, IsAContainerOfTheBodies) {
  const FrameResource frame = random_frame(1, {2, false});
  const auto document = skeletons_document(frame, {"skeletons/"}, latest_options(frame));
  EXPECT_NE((*document->choose(""))->head().find("ldp#BasicContainer>; rel=\"type\""),
            std::string_view::npos);
  const auto graph = graph_at(body_of(document, ""), "http://h/skeletons/");
  const rdf::Triple member{rdf::iri("http://h/skeletons/"),
                           rdf::iri("http://www.w3.org/ns/ldp#contains"),
                           rdf::iri("http://h/skeletons/" + std::to_string(frame.bodies[0].id))};
  EXPECT_NE(std::find(graph.begin(), graph.end(), member), graph.end());
  const rdf::Triple type{rdf::iri("http://h/skeletons/"), rdf::iri(rdf::rdf("type")),
                         rdf::iri("http://www.w3.org/ns/ldp#BasicContainer")};
  EXPECT_NE(std::find(graph.begin(), graph.end(), type), graph.end());
}

}  // namespace
}  // namespace chorus::resource
