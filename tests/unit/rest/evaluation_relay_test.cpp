// What a chorus-evaluation says of the tracker is relayed as it was sent.
#include "fusion-server/rest/evaluation_relay.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/support/served.h"

namespace chorus::rest {
namespace {

Result<client::Document> evaluation_read(const std::string& text) {
  return client::kEvaluations.read(text, resource::Format::Json, testing::sensor_id("evaluation"));
}

TEST(EvaluationRelay, GivesTheNewestAsItWasSent) {
  http::Router router;
  EvaluationRelay relay("run1", router);
  EXPECT_EQ(testing::get(router, "/evaluation").status, 503);
  const std::string sent =
      R"({"@type": "Evaluation", "sequence": 7, "capturedNanoseconds": "1795246200000000000",
          "limbs": [{"state": "off"}]})";
  const auto document = evaluation_read(sent);
  ASSERT_TRUE(document) << to_string(document.error());
  EXPECT_EQ(document->sequence, 7u);
  EXPECT_EQ(document->captured, testing::kStart);
  relay.relay(std::static_pointer_cast<const client::EvaluationText>(document->value));
  const auto answer = testing::get(router, "/evaluation");
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, sent);
  EXPECT_NE(answer.etag.find("run1-7"), std::string::npos);
}

TEST(EvaluationRelay, RefusesWhatIsNoEvaluation) {
  for (const char* text :
       {"", "[]", R"({"@type": "Frame", "sequence": 7, "capturedNanoseconds": "1"})",
        R"({"@type": "Evaluation", "sequence": -1, "capturedNanoseconds": "1"})",
        R"({"@type": "Evaluation", "sequence": 1, "capturedNanoseconds": 1})",
        R"({"@type": "Evaluation", "sequence": 1})"})
    EXPECT_FALSE(evaluation_read(text)) << text;
}

}  // namespace
}  // namespace chorus::rest
