#include "common/resource/terms.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "common/rdf/term.h"
#include "proto/embedded.h"

namespace chorus::resource {
namespace {

TEST(Terms, HaveTheMeaningThatTheContextGivesThem) {
  EXPECT_EQ(term("captured").iri, std::string(kChorus) + "captured");
  EXPECT_EQ(term("captured").type, rdf::xsd("dateTime"));
  EXPECT_EQ(term("bodies").iri, std::string(kChorus) + "body");
  EXPECT_EQ(term("contains").iri, "http://www.w3.org/ns/ldp#contains");
  EXPECT_EQ(term("verdict").type, "@vocab");
  EXPECT_EQ(term("chain").container, Container::List);
  EXPECT_EQ(term("joints").index, std::string(kChorus) + "jointName");
}

TEST(Terms, ATypeMayGiveAKeyItsOwnMeaning) {
  EXPECT_EQ(term("sensors", {"Frame"}).iri, std::string(kChorus) + "sensor");
  EXPECT_EQ(term("sensors", {"Registration"}).iri, std::string(kChorus) + "sensorResource");
  EXPECT_EQ(term("state", {"PolledSensor"}).type, "");
  EXPECT_EQ(term("state").type, "@vocab");
}

TEST(Terms, AnUnknownKeyStandsForItselfAndSaysSo) {
  EXPECT_EQ(term("surprise").iri, std::string(kChorus) + "surprise");
  EXPECT_FALSE(term("surprise").declared);
  EXPECT_TRUE(term("ldp:contains").declared);
  EXPECT_EQ(term("ldp:contains").iri, "http://www.w3.org/ns/ldp#contains");
  EXPECT_EQ(class_iri("Frame"), std::string(kChorus) + "Frame");
  EXPECT_EQ(class_iri("ldp:Container"), "http://www.w3.org/ns/ldp#Container");
  EXPECT_EQ(class_iri("http://x/Y"), "http://x/Y");
}

TEST(Terms, TheContextHoldsOnlyWhatTheTableUnderstands) {
  const auto context = nlohmann::json::parse(proto::context()).at("@context");
  const std::vector<std::string> known{"@id", "@type", "@container", "@index", "@context"};
  for (const auto& [key, value] : context.items()) {
    if (key.starts_with('@')) continue;
    ASSERT_TRUE(value.is_string() || value.is_object()) << key;
    if (!value.is_object()) continue;
    for (const auto& [part, unused] : value.items()) {
      EXPECT_NE(std::find(known.begin(), known.end(), part), known.end()) << key << " has " << part;
    }
  }
  for (const auto& [key, use] : all_terms()) {
    EXPECT_TRUE(use.iri.starts_with("http")) << key;
    EXPECT_TRUE(use.type.empty() || use.type.starts_with('@') || use.type.starts_with("http"))
        << key;
  }
}

}  // namespace
}  // namespace chorus::resource
