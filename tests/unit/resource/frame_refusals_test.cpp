// A frame with a single error is refused in every format, and the refusal names the error.
#include <functional>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/resource/frame_facts.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {
namespace {

using Json = nlohmann::json;

Json good() {
  return Json::parse(R"({
    "@type": "Frame", "@id": "frame", "sequence": 7, "capturedNanoseconds": "1795246200250000000",
    "captured": "2026-11-21T07:30:00.250000000Z", "source": "fusion", "space": "WorldSpace",
    "sensors": ["s1", "s2"],
    "bodies": [{
      "@id": "skeletons/3", "bodyId": 3, "capturedNanoseconds": "1795246200250000000",
      "joints": {
        "Head": {"state": "Tracked", "x": 1.5, "y": "1.7", "z": -2, "qx": 0, "qy": 0, "qz": 0, "qw": 1,
                 "variance": 0.0001, "contributors": ["s2"]},
        "Neck": {"state": "Inferred", "x": 1, "y": 1.5, "z": 2},
        "FootLeft": {"state": "NotTracked"}}}]})");
}

Result<FrameResource> read(const Json& json) { return read_frame(json.dump(), Format::Json); }

TEST(FrameReader, TakesTheGoodFrameThatTheOthersAreMadeOf) {
  const auto frame = read(good());
  ASSERT_TRUE(frame) << to_string(frame.error());
  ASSERT_EQ(frame->bodies.size(), 1U);
  const auto joint = [&](JointId id) { return frame->bodies[0].joints[static_cast<int>(id)]; };
  EXPECT_EQ(joint(JointId::Head).position, Eigen::Vector3d(1.5, 1.7, -2));
  EXPECT_EQ(joint(JointId::Head).contributors, 2U);
  EXPECT_EQ(joint(JointId::Head).variance, 0.0001);
  EXPECT_EQ(joint(JointId::Neck).state, JointState::Inferred);
  EXPECT_EQ(joint(JointId::Neck).variance, std::nullopt);
  EXPECT_EQ(joint(JointId::FootLeft).state, JointState::NotTracked);
  EXPECT_EQ(joint(JointId::HandLeft).state, JointState::NotTracked) << "not there: not tracked";
}

struct Damage {
  const char* name;
  std::function<void(Json&)> harm;
  const char* place;    ///< Part of Error::context.
  const char* message;  ///< Part of Error::message.
};

Json& body(Json& frame) { return frame["bodies"][0]; }
Json& head(Json& frame) { return body(frame)["joints"]["Head"]; }

const std::vector<Damage> kHeadDamages{
    {"other type", [](Json& f) { f["@type"] = "Clock"; }, "@type", "Frame"},
    {"no sequence", [](Json& f) { f.erase("sequence"); }, "ch:sequence", "missing"},
    {"negative sequence", [](Json& f) { f["sequence"] = -1; }, "ch:sequence", "64 bits"},
    {"fraction as sequence", [](Json& f) { f["sequence"] = 1.5; }, "ch:sequence", "no integer"},
    {"text as sequence", [](Json& f) { f["sequence"] = "one"; }, "ch:sequence", "64 bits"},
    {"no time",
     [](Json& f) {
       f.erase("captured");
       f.erase("capturedNanoseconds");
     },
     "ch:captured", "missing"},
    {"time before 1970", [](Json& f) { f["capturedNanoseconds"] = "-5"; }, "Nanoseconds", "1970"},
    {"two times", [](Json& f) { f["captured"] = "2026-11-21T07:30:01Z"; }, "ch:captured",
     "different times"},
    {"no such time", [](Json& f) { f["captured"] = "yesterday"; }, "ch:captured", ""},
    {"number as time", [](Json& f) { f["captured"] = 12; }, "ch:captured", "no string"},
    {"no source", [](Json& f) { f.erase("source"); }, "ch:source", "missing"},
    {"bad source", [](Json& f) { f["source"] = "a b"; }, "ch:source", ""},
    {"no space", [](Json& f) { f.erase("space"); }, "ch:space", "missing"},
    {"other space", [](Json& f) { f["space"] = "OuterSpace"; }, "ch:space", "none of SensorSpace"},
    {"sensors no list", [](Json& f) { f["sensors"] = "s1"; }, "ch:sensors", "no array"},
    {"sensor no text", [](Json& f) { f["sensors"] = {1}; }, "ch:sensors", "no string"},
    {"bad sensor",
     [](Json& f) {
       f["sensors"] = {"s1", "s2", ""};
     },
     "ch:sensor", ""},
    {"too many sensors",
     [](Json& f) {
       for (int i = 0; i < 70; ++i) f["sensors"].push_back("x" + std::to_string(i));
     },
     "ch:sensor", "64"},
    {"bodies no list", [](Json& f) { f["bodies"] = 1; }, "ch:bodies", "no array"},
    {"body no object", [](Json& f) { f["bodies"].push_back(1); }, "ch:bodies", "no object"}};

const std::vector<Damage> kBodyDamages{
    {"no id", [](Json& f) { body(f).erase("bodyId"); }, "skeletons/3 ch:bodyId", "missing"},
    {"same id", [](Json& f) { f["bodies"].push_back(body(f)); }, "ch:bodyId", "two bodies"},
    {"no time", [](Json& f) { body(f).erase("capturedNanoseconds"); }, "ch:captured", "missing"},
    {"joints no object", [](Json& f) { body(f)["joints"] = 3; }, "ch:joints", "no object"},
    {"joint no object", [](Json& f) { body(f)["joints"]["Neck"] = 3; }, "ch:joints", "no object"},
    {"strange joint", [](Json& f) { body(f)["joints"]["Tail"] = head(f); }, "ch:jointName",
     "'Tail'"},
    {"no state", [](Json& f) { head(f).erase("state"); }, "skeletons/3#Head ch:state", "missing"},
    {"strange state", [](Json& f) { head(f)["state"] = "Guessed"; }, "ch:state", "none of"},
    {"no position",
     [](Json& f) {
       for (const char* axis : {"x", "y", "z"}) head(f).erase(axis);
     },
     "ch:x", "position"},
    {"half a position", [](Json& f) { head(f).erase("y"); }, "ch:y", "beside the others"},
    {"far away", [](Json& f) { head(f)["z"] = 10'001; }, "ch:x", "10000 m"},
    {"not a number", [](Json& f) { head(f)["x"] = "NaN"; }, "ch:x", "no finite number"},
    {"truth as number", [](Json& f) { head(f)["x"] = true; }, "ch:x", "no finite number"},
    {"half an orientation", [](Json& f) { head(f).erase("qz"); }, "ch:qz", "beside the others"},
    {"long orientation", [](Json& f) { head(f)["qw"] = 2; }, "ch:qw", "length 1"},
    {"negative variance", [](Json& f) { head(f)["variance"] = -1e-9; }, "ch:variance", "between 0"},
    {"huge variance", [](Json& f) { head(f)["variance"] = 1e5; }, "ch:variance", "between 0"},
    {"strange contributor", [](Json& f) { head(f)["contributors"] = {"s9"}; }, "ch:contributor",
     "'s9'"},
    {"shares no list", [](Json& f) { head(f)["shares"] = "1"; }, "ch:shares", "no array"},
    {"a share no number", [](Json& f) { head(f)["shares"] = {"much"}; }, "ch:shares", "no finite"},
    {"two shares of one sensor",
     [](Json& f) {
       head(f)["shares"] = {0.5, 0.5};
     },
     "ch:shares", "one share for each"},
    {"shares that make more than all",
     [](Json& f) {
       head(f)["contributors"] = {"s1", "s2"};
       head(f)["shares"] = {0.8, 0.8};
     },
     "ch:shares", "make 1"},
    {"a negative share",
     [](Json& f) {
       head(f)["contributors"] = {"s1", "s2"};
       head(f)["shares"] = {-0.2, 1.2};
     },
     "ch:shares", "make 1"},
    {"a joint from the future", [](Json& f) { head(f)["age"] = -0.001; }, "ch:age", "between 0"},
    {"contributors no list", [](Json& f) { head(f)["contributors"] = "s1"; }, "ch:contributors",
     "no array"}};

/// The head as a camera's: a direction instead of a position.
Json& ray(Json& frame) {
  for (const char* axis : {"x", "y", "z"}) head(frame).erase(axis);
  head(frame)["rayX"] = 0.6;
  head(frame)["rayY"] = 0;
  head(frame)["rayZ"] = 0.8;
  return head(frame);
}

/// A covariance of the head with this first variance.
void spread(Json& frame, double cxx) {
  head(frame).update(
      {{"cxx", cxx}, {"cxy", 0}, {"cxz", 0}, {"cyy", 0.01}, {"cyz", 0}, {"czz", 0.01}});
}

const std::vector<Damage> kMeasurementDamages{
    {"half a ray", [](Json& f) { ray(f).erase("rayZ"); }, "skeletons/3#Head ch:rayZ",
     "beside the others"},
    {"long ray", [](Json& f) { ray(f)["rayX"] = 0.7; }, "ch:rayX", "length 1"},
    {"ray of length 0", [](Json& f) { ray(f)["rayX"] = ray(f)["rayZ"] = 0; }, "ch:rayX", ""},
    {"ray and position",
     [](Json& f) {
       ray(f)["x"] = 1;
       head(f)["y"] = head(f)["z"] = 0;
     },
     "ch:rayX", "a position or a ray"},
    {"half a covariance",
     [](Json& f) {
       spread(f, 0.01);
       head(f).erase("cyz");
     },
     "ch:cyz", "beside the others"},
    {"negative covariance", [](Json& f) { spread(f, -0.01); }, "ch:cxx", "negative variance"},
    {"huge covariance", [](Json& f) { spread(f, 10'001); }, "ch:cxx", "beyond 10000"},
    {"impossible covariance",
     [](Json& f) {
       spread(f, 0.01);
       head(f)["cxy"] = 0.02;
     },
     "ch:cxx", "negative variance"},
    {"an old joint", [](Json& f) { head(f)["age"] = 3600.001; }, "ch:age", "3600 s"},
    {"age of somebody", [](Json& f) { head(f)["age"] = "old"; }, "ch:age", "no finite number"}};

const std::vector<Damage> kPersonDamages{
    {"no such slot", [](Json& f) { body(f)["slot"] = kMaxBodies; }, "skeletons/3 ch:slot", "above"},
    {"negative slot", [](Json& f) { body(f)["slot"] = -1; }, "ch:slot", "wrong sign"},
    {"one slot of two",
     [](Json& f) {
       body(f)["slot"] = 1;
       f["bodies"].push_back(body(f));
       f["bodies"][1]["bodyId"] = 4;
     },
     "ch:slot", "two bodies have the slot 1"},
    {"more than sure", [](Json& f) { body(f)["sidesConfidence"] = 1.01; }, "ch:sidesConfidence",
     "between 0 and 1"},
    {"less than unsure", [](Json& f) { body(f)["sidesConfidence"] = -0.01; }, "ch:sidesConfidence",
     "between 0 and 1"},
    {"carried for ever", [](Json& f) { body(f)["carriedFor"] = 3601; }, "ch:carriedFor", "3600 s"},
    {"smoothed for ever", [](Json& f) { body(f)["smoothedOver"] = 3601; }, "ch:smoothedOver",
     "3600 s"},
    {"carried before", [](Json& f) { body(f)["carriedFor"] = -1; }, "ch:carriedFor", "between 0"},
    {"carried somehow", [](Json& f) { body(f)["carriedFor"] = Json::array(); }, "ch:carriedFor",
     "no finite number"},
    {"a body of its own time", [](Json& f) { body(f)["captured"] = "2026-11-21T07:30:02Z"; },
     "skeletons/3 ch:captured", "different times"}};

void expect_refused(const Damage& damage) {
  Json frame = good();
  damage.harm(frame);
  const auto refused = read(frame);
  ASSERT_FALSE(refused) << damage.name;
  EXPECT_EQ(refused.error().code, ErrorCode::Malformed) << damage.name;
  EXPECT_NE(refused.error().context.find(damage.place), std::string::npos)
      << damage.name << ": " << to_string(refused.error());
  EXPECT_NE(refused.error().message.find(damage.message), std::string::npos)
      << damage.name << ": " << to_string(refused.error());
}

TEST(FrameReader, RefusesAFrameWithADamagedHeadByName) {
  for (const Damage& damage : kHeadDamages) expect_refused(damage);
}

TEST(FrameReader, RefusesAFrameWithADamagedBodyByName) {
  for (const Damage& damage : kBodyDamages) expect_refused(damage);
}

TEST(FrameReader, RefusesADamagedMeasurementByName) {
  for (const Damage& damage : kMeasurementDamages) expect_refused(damage);
}

TEST(FrameReader, RefusesWhatCannotBeOfAPersonByName) {
  for (const Damage& damage : kPersonDamages) expect_refused(damage);
}

TEST(FrameReader, TakesTheLimitsThemselves) {
  Json frame = good();
  body(frame)["slot"] = kMaxBodies - 1;
  body(frame)["sidesConfidence"] = 1;
  body(frame)["carriedFor"] = 3600;
  body(frame)["smoothedOver"] = 3600;
  ray(frame);
  spread(frame, 10'000);
  head(frame)["variance"] = 10'000;
  head(frame)["age"] = 3600;
  const auto taken = read(frame);
  ASSERT_TRUE(taken) << to_string(taken.error());
  const BodyResource& person = taken->bodies.at(0);
  EXPECT_EQ(person.slot, kMaxBodies - 1);
  EXPECT_EQ(person.sides_confidence, 1.0);
  EXPECT_EQ(person.carried_for, 3600.0);
  EXPECT_EQ(person.smoothed_over, 3600.0);
  const JointResource& joint = person.joints[static_cast<int>(JointId::Head)];
  EXPECT_EQ(joint.measurement, Measurement::Ray);
  EXPECT_EQ(joint.position, Eigen::Vector3d(0.6, 0, 0.8));
  EXPECT_EQ(joint.covariance.matrix()(0, 0), 10'000);
  EXPECT_EQ(joint.variance, 10'000);
  EXPECT_EQ(joint.age, 3600);
}

TEST(FrameReader, TakesTimesThatDifferByRoundingAlone) {
  Json frame = good();
  frame["captured"] = "2026-11-21T07:30:00.251Z";
  const auto taken = read(frame);
  ASSERT_TRUE(taken) << to_string(taken.error());
  EXPECT_EQ(to_unix_ns(taken->captured), 1'795'246'200'250'000'000) << "the exact one counts";
  frame["captured"] = "2026-11-21T07:30:00.251000001Z";
  EXPECT_FALSE(read(frame)) << "more than a millisecond";
  frame = good();
  frame.erase("capturedNanoseconds");
  EXPECT_EQ(to_unix_ns(read(frame)->captured), 1'795'246'200'250'000'000) << "either alone will do";
}

TEST(FrameReader, RefusesMoreBodiesThanThereMayBe) {
  Json frame = good();
  for (int i = 0; i < 200; ++i) {
    frame["bodies"].push_back(body(frame));
    frame["bodies"].back()["bodyId"] = 100 + i;
  }
  const auto refused = read(frame);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::TooLarge);
}

/// A sensor whose document describes very many things would keep the reader from serving the other
/// sensors.
TEST(FrameReader, RefusesADocumentThatSpeaksOfTooManyThings) {
  const auto frame = read(good());
  ASSERT_TRUE(frame);
  const std::string turtle = write(*frame, Format::Turtle);
  const auto with = [&](int strangers) {
    std::string text = turtle;
    for (int i = 0; i < strangers; ++i) text += "<x" + std::to_string(i) + "> <urn:p> 1 .\n";
    return read_frame(text, Format::Turtle);
  };
  EXPECT_TRUE(with(4000));
  const auto refused = with(4100);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::TooLarge);
  EXPECT_NE(refused.error().message.find("4096 things"), std::string::npos);
}

TEST(FrameReader, SaysWhatToDoWithNaNAndWithOtherNames) {
  std::string text = good().dump();
  text.replace(text.find(":1.5"), 4, ":NaN");
  EXPECT_NE(read_frame(text, Format::Json).error().message.find("leave out a joint"),
            std::string::npos);
  Json other = good();
  head(other)["state"] = "tracked";
  const std::string expected = "is none of Tracked, Inferred and NotTracked";
  EXPECT_EQ(read(other).error().message, expected);
  const auto frame = read(good());
  ASSERT_TRUE(frame);
  std::string turtle = write(*frame, Format::Turtle);
  turtle.replace(turtle.find("ch:Tracked"), 10, "ch:Seen");
  EXPECT_EQ(read_frame(turtle, Format::Turtle).error().message, expected);
}

TEST(FrameReader, ForgivesWhatChangesNothing) {
  const std::vector<std::function<void(Json&)>> harmless{
      [](Json& f) { f["remark"] = "of another program"; },
      [](Json& f) { f.erase("@type"); },
      [](Json& f) { f["sequence"] = "7"; },
      [](Json& f) { f.erase("captured"); },
      [](Json& f) { f.erase("bodies"); },
      [](Json& f) { body(f)["joints"] = Json::object(); },
      [](Json& f) { head(f)["qx"] = head(f)["qy"] = head(f)["qz"] = head(f)["qw"] = 0; },
      [](Json& f) { head(f)["qw"] = 1.05; },
      [](Json& f) { head(f)["x"] = "1.5e0"; },
      [](Json& f) { body(f)["joints"]["FootLeft"]["x"] = 3; }};
  for (std::size_t i = 0; i < harmless.size(); ++i) {
    Json frame = good();
    harmless[i](frame);
    const auto read_back = read(frame);
    EXPECT_TRUE(read_back) << i << ": " << to_string(read_back.error());
  }
}

TEST(FrameReader, TheSameDamageInTurtleIsRefusedToo) {
  const std::string turtle = write(*read(good()), Format::Turtle);
  const auto without = [&](const std::string& part, const std::string& instead) {
    std::string text = turtle;
    const auto at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    text.replace(at, part.size(), instead);
    return read_frame(text, Format::Turtle);
  };
  EXPECT_TRUE(without("1.7000", "1.7001"));
  for (const auto& [part, instead] : std::vector<std::pair<std::string, std::string>>{
           {"ch:sequence 7", "ch:sequence -7"},
           {"ch:sequence 7", "ch:sequence 7 , 8"},
           {"ch:WorldSpace", "ch:OuterSpace"},
           {"1.7000", "\"NaN\"^^<http://www.w3.org/2001/XMLSchema#double>"},
           {"1.7000", "\"high\""},
           {"ch:Tracked", "ch:Guessed"},
           {"\"fusion\"", "\"a b\""}}) {
    EXPECT_FALSE(without(part, instead)) << part << " => " << instead;
  }
}

TEST(FrameReader, CutOffAnywhereIsRefusedAndNeverACrash) {
  for (const Format format : kFormats) {
    const std::string whole = write(*read(good()), format);
    for (std::size_t kept = 0; kept + 2 < whole.size(); kept += 7) {
      const auto part = read_frame(std::string_view(whole).substr(0, kept), format);
      EXPECT_TRUE(!part || format == Format::NTriples) << media_type(format) << " " << kept;
    }
  }
}

TEST(FrameFacts, ADocumentHoldsOneFrame) {
  EXPECT_FALSE(assemble({}));
  SubjectFacts frame;
  frame.is_frame = true;
  frame.name = "frame";
  const auto twice = assemble({frame, frame});
  ASSERT_FALSE(twice);
  EXPECT_NE(twice.error().message.find("one frame"), std::string::npos);
}

TEST(FrameFacts, AContradictionIsNotSetAndTheSameTwiceIsNone) {
  std::optional<int> property;
  EXPECT_TRUE(set_once(property, 3));
  EXPECT_TRUE(set_once(property, 3));
  EXPECT_FALSE(set_once(property, 4));
  EXPECT_EQ(property, 3);
}

TEST(FrameFacts, PlacesAreShortAndReadable) {
  SubjectFacts subject;
  subject.name = "skeletons/\xFF" + std::string(500, 'a');
  const std::string place = place_of(subject, "x");
  EXPECT_LT(place.size(), 140U);
  EXPECT_TRUE(place.ends_with(" ch:x"));
  EXPECT_NE(place.find("\xEF\xBF\xBD"), std::string::npos);
}

}  // namespace
}  // namespace chorus::resource
