#include "common/synthetic/kinect/profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace chorus::synthetic::kinect {
namespace {

nlohmann::json file() {
  std::ifstream text("common/synthetic/kinect/profiles.json");
  return nlohmann::json::parse(text, nullptr, true, true);
}

/// Converts the value to SI units according to the unit at the end of the name.
double si(const std::string& name, double value) {
  if (name.ends_with("_deg")) return value * std::acos(-1.0) / 180.0;
  if (name.ends_with("_mm") || name.ends_with("_ms")) return value * 1e-3;
  if (name.ends_with("_ppm")) return value * 1e-6;
  return value;
}

TEST(Profile, EveryEntryOfTheFileIsBoundAndEveryBindingHasAnEntry) {
  const nlohmann::json parsed = file();
  std::set<std::string> written;
  for (const auto& [name, entry] : parsed.items()) written.insert(name);
  std::set<std::string> bound;
  for (const Parameter& each : parameters_of(Profile{})) {
    EXPECT_TRUE(bound.insert(std::string(each.name)).second) << each.name << " is bound twice";
  }
  EXPECT_EQ(bound, written);
  EXPECT_GT(bound.size(), 50u);
}

TEST(Profile, EveryEntrySaysItsValuesItsIntervalAndWhereTheyComeFrom) {
  const nlohmann::json parsed = file();
  for (const auto& [name, entry] : parsed.items()) {
    EXPECT_EQ(entry.size(), 5u) << name;
    EXPECT_TRUE(entry.at("A").is_number()) << name;
    EXPECT_TRUE(entry.at("B").is_number()) << name;
    EXPECT_TRUE(entry.at("D").is_number()) << name;
    EXPECT_GE(entry.at("spread").get<double>(), 0.0) << name;
    EXPECT_LT(entry.at("spread").get<double>(), 1.0) << name;
    EXPECT_FALSE(entry.at("source").get<std::string>().empty()) << name;
  }
}

TEST(Profile, NominalValuesAreTheFilesInMetresRadiansSeconds) {
  const nlohmann::json written = file();
  for (const char* profile : {"A", "B", "D"}) {
    for (const Parameter& each : parameters_of(nominal_profile(profile))) {
      const std::string name(each.name);
      EXPECT_NEAR(each.value, si(name, written.at(name).at(profile).get<double>()), 1e-12) << name;
    }
  }
  EXPECT_NEAR(nominal_profile("A").delivery.period, 0.033, 1e-3);
}

TEST(Profile, NoTwoBindingsShareAField) {
  // A draw gives a new value to every parameter that has an interval.
  const nlohmann::json written = file();
  std::set<double> values;
  std::size_t drawn = 0;
  for (const Parameter& each : parameters_of(draw_profile("B", 5))) {
    const nlohmann::json& entry = written.at(std::string(each.name));
    if (entry.at("spread") == 0.0 || entry.at("B") == 0.0) continue;
    ++drawn;
    EXPECT_TRUE(values.insert(each.value).second) << each.name;
  }
  EXPECT_GT(drawn, 30u);
}

TEST(Profile, DrawsStayInTheirIntervalAndFillIt) {
  const nlohmann::json written = file();
  std::map<std::string, std::pair<double, double>> reached;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    for (const Parameter& each : parameters_of(draw_profile("A", seed))) {
      const std::string name(each.name);
      const double nominal = si(name, written.at(name).at("A").get<double>());
      const double spread = written.at(name).at("spread").get<double>();
      EXPECT_GE(each.value, nominal * (1 - spread) - 1e-12) << name;
      EXPECT_LE(each.value, nominal * (1 + spread) + 1e-12) << name;
      if (nominal * spread == 0) continue;
      auto& [least, most] = reached.try_emplace(name, 1.0, -1.0).first->second;
      const double place = (each.value / nominal - 1) / spread;
      least = std::min(least, place);
      most = std::max(most, place);
    }
  }
  EXPECT_GT(reached.size(), 30u);
  for (const auto& [name, range] : reached) {
    EXPECT_LT(range.first, -0.8) << name;
    EXPECT_GT(range.second, 0.8) << name;
  }
}

TEST(Profile, TheSameSeedGivesTheSameDraw) {
  const auto one = parameters_of(draw_profile("A", 3));
  const auto again = parameters_of(draw_profile("A", 3));
  const auto other = parameters_of(draw_profile("A", 4));
  bool differs = false;
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].value, again[i].value) << one[i].name;
    differs |= one[i].value != other[i].value;
  }
  EXPECT_TRUE(differs);
}

// Frozen after calibration.  A change of any number or line of code of the model changes every
// published result: then say so in docs/benchmarks/model.md, run the benchmarks again, and pin the
// new hash here.  Comments do not count.
TEST(Profile, IsFrozen) { EXPECT_EQ(frozen_hash(), "155b5c972fe8"); }

}  // namespace
}  // namespace chorus::synthetic::kinect
