// /orientations and the calibration of inertial sensors: written, read again, refused.
#include "common/resource/orientations_resource.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "common/geometry/rotation.h"
#include "common/resource/inertial_calibration_resource.h"
#include "common/resource/orientations_scan.h"

namespace chorus::resource {
namespace {

using inertial::InertialFrame;
using inertial::InertialReading;
using ::testing::HasSubstr;

const Timestamp kThen = from_unix_ns(1'795'246'200'250'000'001);

InertialReading forearm(Timestamp at) {
  InertialReading one;
  one.sensor = "00B4891F";
  one.captured = at;
  one.limb = inertial::Limb::ForearmLeft;
  one.inertial_from_sensor = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  Eigen::Matrix3d covariance;
  covariance << 3e-4, 1e-5, -2e-5, 1e-5, 4e-4, 3e-5, -2e-5, 3e-5, 9e-3;
  one.covariance = covariance;
  one.acceleration = Eigen::Vector3d(0.1, 9.81, -0.25);
  one.rate = Eigen::Vector3d(-1.5, 0.001, 2.0);
  one.field = Eigen::Vector3d(20.5, -3.0, 41.25);
  one.magnetic = inertial::MagneticState::Disturbed;
  one.battery = 0.82;
  return one;
}

OrientationsResource two_instants() {
  OrientationsResource out;
  out.sequence = 17;
  out.source = "suit";
  const SensorId source = *SensorId::parse("suit");
  for (const int i : {0, 1}) {
    InertialFrame& frame = out.instants.emplace_back();
    frame.source = source;
    frame.sequence = static_cast<std::uint64_t>(33 + i);
    frame.captured = kThen + std::chrono::milliseconds(10) * i;
    frame.readings.push_back(forearm(frame.captured));
    InertialReading& tail = frame.readings.emplace_back();
    tail.sensor = "tail";
    tail.captured = frame.captured - std::chrono::milliseconds(2);
    tail.free_acceleration = Eigen::Vector3d(0, -1, 2);
  }
  out.captured = out.instants.back().captured;
  return out;
}

void expect_same_reading(const InertialReading& a, const InertialReading& b) {
  EXPECT_EQ(a.sensor, b.sensor);
  EXPECT_EQ(a.captured, b.captured);
  EXPECT_EQ(a.limb, b.limb);
  EXPECT_EQ(a.magnetic, b.magnetic);
  EXPECT_EQ(a.battery, b.battery);
  ASSERT_EQ(a.inertial_from_sensor.has_value(), b.inertial_from_sensor.has_value());
  if (a.inertial_from_sensor) {
    EXPECT_LT(a.inertial_from_sensor->angularDistance(*b.inertial_from_sensor), 3e-6);
  }
  ASSERT_EQ(a.covariance.has_value(), b.covariance.has_value());
  if (a.covariance) {
    EXPECT_LT((*a.covariance - *b.covariance).cwiseAbs().maxCoeff(), 1e-9);
  }
  const auto near = [](const auto& u, const auto& v) {
    return u.has_value() == v.has_value() && (!u || (*u - *v).norm() < 2e-5);
  };
  EXPECT_TRUE(near(a.acceleration, b.acceleration) && near(a.rate, b.rate) &&
              near(a.field, b.field) && near(a.free_acceleration, b.free_acceleration));
}

TEST(Orientations, AreTheSameAfterJsonAndJsonLd) {
  const OrientationsResource all = two_instants();
  for (const Format format : {Format::Json, Format::JsonLd}) {
    const auto read = read_orientations(write(all, format), format);
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(read->sequence, 17u);
    EXPECT_EQ(read->source, "suit");
    EXPECT_EQ(read->captured, all.captured);
    ASSERT_EQ(read->instants.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(read->instants[i].sequence, all.instants[i].sequence);
      EXPECT_EQ(read->instants[i].captured, all.instants[i].captured);
      ASSERT_EQ(read->instants[i].readings.size(), 2u);
      for (std::size_t k = 0; k < 2; ++k)
        expect_same_reading(all.instants[i].readings[k], read->instants[i].readings[k]);
    }
  }
}

TEST(Orientations, UseDeclaredTermsOnly) {
  EXPECT_THAT(undeclared_terms(orientations_node(two_instants())), ::testing::IsEmpty());
}

std::string golden_orientations(const std::string& name) {
  std::ifstream file("proto/golden/documents/" + name, std::ios::binary);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(Orientations, AreWrittenAsTheGoldenDocuments) {
  const OrientationsResource all = two_instants();
  const Place place{"orientations"};
  EXPECT_EQ(write(all, Format::Turtle, place), golden_orientations("orientations.ttl"));
  EXPECT_EQ(write(all, Format::Json, place), golden_orientations("orientations.json"));
  EXPECT_EQ(write(all, Format::JsonLd, place), golden_orientations("orientations.jsonld"));
}

/// Why the document is refused in which `from` was replaced by `to`.
std::string why_refused(const std::string& from, const std::string& to) {
  std::string text = write(two_instants(), Format::Json);
  const auto at = text.find(from);
  if (at == std::string::npos) return "has no " + from;
  text.replace(at, from.size(), to);
  const auto read = read_orientations(text, Format::Json);
  return read ? "taken" : to_string(read.error());
}

TEST(Orientations, SayWhatIsWrongWithThem) {
  EXPECT_THAT(why_refused("\"ForearmLeft\"", "\"LeftForearm\""), HasSubstr("names no limb"));
  EXPECT_THAT(why_refused("\"qx\": -0.5", "\"qx\": -5"), HasSubstr("unit length"));
  EXPECT_THAT(why_refused("\"qx\": -0.5,", ""), HasSubstr("other components"));
  EXPECT_THAT(why_refused("\"rxx\": 0.0003", "\"rxx\": -0.0003"), HasSubstr("negative variance"));
  EXPECT_THAT(why_refused("\"disturbed\"", "\"magic\""), HasSubstr("magneticState"));
  EXPECT_THAT(why_refused("\"accelerationX\": 0.1", "\"accelerationX\": 1e300"),
              HasSubstr("million"));
  EXPECT_THAT(why_refused("\"sequence\": 17", "\"sequence\": -17"), HasSubstr("whole number"));
  EXPECT_THAT(why_refused("\"suit\"", "\"a suit\""), HasSubstr("sensor id"));
  EXPECT_THAT(why_refused("\"Orientations\"", "\"Frame\""), HasSubstr("@type"));
  EXPECT_THAT(why_refused("1795246200260000001", "1795246200260000002"),
              HasSubstr("newest instant"));
  EXPECT_FALSE(read_orientations("[]", Format::Json));
  EXPECT_FALSE(read_orientations(write(two_instants(), Format::Turtle), Format::Turtle));
}

TEST(Orientations, OfNobodyOrTooManyInstantsAreRefused) {
  OrientationsResource none = two_instants();
  none.instants.clear();
  EXPECT_FALSE(read_orientations(write(none, Format::Json), Format::Json));
  OrientationsResource many = two_instants();
  while (many.instants.size() <= kMaxInstants) {
    many.instants.push_back(many.instants.back());
    many.instants.back().captured += std::chrono::milliseconds(1);
  }
  many.captured = many.instants.back().captured;
  EXPECT_FALSE(read_orientations(write(many, Format::Json), Format::Json));
  many.instants.pop_back();
  many.captured = many.instants.back().captured;
  EXPECT_TRUE(read_orientations(write(many, Format::Json), Format::Json));
}

TEST(InertialCalibrations, AreTheSameAfterJsonAndJsonLd) {
  inertial::InertialCalibration calibration{"suit", kThen, {}};
  inertial::SensorCalibration& one = calibration.sensors.emplace_back();
  one.sensor = "00B4891F";
  one.limb = inertial::Limb::ForearmLeft;
  one.heading = -2.5;
  one.limb_from_sensor = Eigen::Quaterniond(0.5, -0.5, 0.5, 0.5);
  one.covariance = Eigen::Vector4d(1e-4, 2e-4, 3e-4, 4e-4).asDiagonal();
  one.covariance(0, 3) = one.covariance(3, 0) = -1e-5;
  one.residual = 0.05;
  one.prediction_sigma = 0.1;
  EXPECT_THAT(undeclared_terms(inertial_calibration_node(calibration)), ::testing::IsEmpty());
  for (const Format format : {Format::Json, Format::JsonLd}) {
    const auto read = read_inertial_calibration(write(calibration, format), format);
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(read->source, "suit");
    EXPECT_EQ(read->made, kThen);
    ASSERT_EQ(read->sensors.size(), 1u);
    const auto& got = read->sensors[0];
    EXPECT_EQ(got.limb, one.limb);
    EXPECT_NEAR(got.heading, one.heading, 1e-6);
    EXPECT_LT(got.limb_from_sensor.angularDistance(one.limb_from_sensor), 3e-6);
    EXPECT_LT((got.covariance - one.covariance).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_NEAR(got.prediction_sigma, 0.1, 1e-6);
  }
  std::string text = write(calibration, Format::Json);
  text.replace(text.find("ForearmLeft"), 11, "ForearmLost");
  EXPECT_FALSE(read_inertial_calibration(text, Format::Json));
}

void expect_same(const OrientationsResource& a, const OrientationsResource& b) {
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.captured, b.captured);
  EXPECT_EQ(a.source, b.source);
  ASSERT_EQ(a.instants.size(), b.instants.size());
  for (std::size_t i = 0; i < a.instants.size(); ++i) {
    EXPECT_EQ(a.instants[i].sequence, b.instants[i].sequence);
    EXPECT_EQ(a.instants[i].captured, b.instants[i].captured);
    EXPECT_EQ(a.instants[i].source, b.instants[i].source);
    ASSERT_EQ(a.instants[i].readings.size(), b.instants[i].readings.size());
    for (std::size_t r = 0; r < a.instants[i].readings.size(); ++r) {
      const InertialReading& one = a.instants[i].readings[r];
      const InertialReading& other = b.instants[i].readings[r];
      expect_same_reading(one, other);
      EXPECT_EQ(one.inertial_from_sensor.has_value(), other.inertial_from_sensor.has_value());
      if (!one.inertial_from_sensor || !other.inertial_from_sensor) continue;
      EXPECT_EQ(one.inertial_from_sensor->coeffs(), other.inertial_from_sensor->coeffs());
    }
  }
}

TEST(OrientationsScan, ReadsWhatIsWrittenAsTheParserDoes) {
  OrientationsResource said = two_instants();
  for (const char* name : {"zeta", "alpha", "B-7"}) {
    said.instants[1].readings.push_back(forearm(said.instants[1].captured));
    said.instants[1].readings.back().sensor = name;
  }
  const std::string text = write(said, Format::Json);
  const auto scanned = scan_orientations(text);
  ASSERT_TRUE(scanned);
  const auto parsed = parse_orientations(text);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  expect_same(*scanned, *parsed);
}

TEST(OrientationsScan, TakesNothingThatTheParserRefusesOrReadsOtherwise) {
  const std::string text = write(two_instants(), Format::Json);
  const std::string_view other = "0123456789\"{}[],:-.eE x\\q\x01";
  int taken = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (std::size_t k = 0; k < 3; ++k) {
      std::string changed = text;
      if (k < 2)
        changed[at] = other[(at * 7 + 11 * k) % other.size()];
      else
        changed.erase(at, 1);
      const auto scanned = scan_orientations(changed);
      if (!scanned) continue;
      const auto parsed = parse_orientations(changed);
      ASSERT_TRUE(parsed) << changed.substr(at > 20 ? at - 20 : 0, 60);
      expect_same(*scanned, *parsed);
      ++taken;
    }
  }
  EXPECT_GT(taken, 100);
}

TEST(OrientationsScan, LeavesToTheParserWhatItDoesNotKnow) {
  const std::string text = write(two_instants(), Format::Json);
  const auto with = [&](const char* what, const char* instead) {
    std::string changed = text;
    changed.replace(changed.find(what), std::string_view(what).size(), instead);
    return changed;
  };
  for (const std::string& each :
       {with("\"battery\"", "\"mood\": 3, \"battery\""), with("\"qx\"", "\"qx\": 1, \"qx\""),
        with("\"tail\"", "\"00B4891F\""), with("\"tail\"", "\"t\\u0061il\""), text + " x",
        with("\"qw\"", "\"qv\""), std::string("{}"), std::string()}) {
    EXPECT_FALSE(scan_orientations(each)) << each.substr(0, 40);
  }
  EXPECT_TRUE(read_orientations(with("\"battery\"", "\"mood\": 3, \"battery\""), Format::Json));
  EXPECT_TRUE(read_orientations(with("\"tail\"", "\"t\\u0061il\""), Format::Json));
  EXPECT_FALSE(read_orientations(with("\"qx\"", "\"qx\": 1, \"qx\""), Format::Json));
}

}  // namespace
}  // namespace chorus::resource
