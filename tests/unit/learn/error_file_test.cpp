#include "fusion-server/learn/error_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

namespace chorus::learn {
namespace {

using enum JointId;
using fusion::PredictorKind;
using ::testing::HasSubstr;

fusion::ErrorPredictor example(PredictorKind kind) {
  fusion::ErrorPredictor predictor;
  predictor.kind = kind;
  predictor.trained_on = "three people, six sensors";
  predictor.ranges[3] = {1.0, 4.5, 2.25};
  fusion::JointPredictor joint{1.2, 0.004, 0.3, -3.75};
  if (kind == PredictorKind::Boosting) {
    joint.trees = {{{3, 2.5F, 1, 2, false}, {-1, 0.1}, {-1, 0.3}},
                   {{-1, -0.2}},
                   {{0, 0.5F, 1, 2, true}, {-1, 0.2}, {-1, -0.1}}};
  } else {
    joint.coefficients[3] = 0.1;
  }
  predictor.joints[index_of(Head)] = joint;
  predictor.joints[index_of(HandTipLeft)] = joint;
  return predictor;
}

std::string text_of(PredictorKind kind = PredictorKind::Gamma) {
  return write_predictor(example(kind));
}

/// The file with one piece of text replaced, which must be there.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from << " is not in " << text;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string why(const std::string& text) {
  const auto read = read_predictor(text);
  return read ? "accepted" : to_string(read.error());
}

TEST(ErrorFile, ReadsWhatItWrote) {
  for (std::size_t kind = 0; kind < fusion::kPredictorNames.size(); ++kind) {
    const auto predictor = example(static_cast<PredictorKind>(kind));
    const auto read = read_predictor(write_predictor(predictor));
    ASSERT_TRUE(read) << to_string(read.error());
    EXPECT_EQ(*read, predictor);
  }
}

TEST(ErrorFile, SaysWhatIsWrong) {
  const std::string good = text_of();
  const std::string trees = text_of(PredictorKind::Boosting);
  EXPECT_THAT(why(""), HasSubstr("is empty"));
  EXPECT_THAT(why("[]"), HasSubstr("no file of `chorus train-error`"));
  EXPECT_THAT(why("{}"), HasSubstr("no file of `chorus train-error`"));
  EXPECT_THAT(why(with(good, "\"version\":1", "\"version\":2")), HasSubstr("version: must be 1"));
  EXPECT_THAT(why(with(good, "\"gamma\"", "\"delta\"")), HasSubstr("kind: must be constant"));
  EXPECT_THAT(why(with(good, "\"Head\"", "\"Hat\"")), HasSubstr("joints.Hat: is not one of"));
  EXPECT_THAT(why(with(good, "\"rms\":1.2", "\"rms\":-1")),
              HasSubstr("rms: must be a number from 0 to 100"));
  EXPECT_THAT(why(with(good, "-3.75", "1e300")), HasSubstr("constant: must be a number"));
  EXPECT_THAT(why(with(good, "-3.75", "null")), HasSubstr("constant: must be a number"));
  EXPECT_THAT(why(with(good, "{\"distance_m\":0.1}", "{\"mood\":0.1}")),
              HasSubstr("unknown feature 'mood'"));
  EXPECT_THAT(why(with(good, "\"most\":4.5", "\"most\":0.5")),
              HasSubstr("features.distance_m.most: must be a number from 1"));
  EXPECT_THAT(why(with(good, "\"coefficients\"", "\"trees\"")),
              HasSubstr("coefficients: must be an object"));
  EXPECT_THAT(why(with(trees, "[3,2.5,1,2,0]", "[3,2.5,0,2,0]")),
              HasSubstr("trees.0.0: names a feature or a node that does not exist"));
  EXPECT_THAT(why(with(trees, "[3,2.5,1,2,0]", "[3,2.5,1,3,0]")), HasSubstr("does not exist"));
  EXPECT_THAT(why(with(trees, "[3,2.5,1,2,0]", "[7,2.5,1,2,0]")), HasSubstr("does not exist"));
  EXPECT_THAT(why(with(trees, "[3,2.5,1,2,0]", "[3,2.5]")), HasSubstr("must be [value] or"));
  EXPECT_THAT(why(with(trees, "[[-0.2]]", "[]")), HasSubstr("must be an array of 1 to"));
}

/// Whatever happens to a byte, the file is refused or can be used.
TEST(ErrorFile, SurvivesDamage) {
  std::string good = text_of(PredictorKind::Boosting);
  good.pop_back();  // the line end, which may be missing
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (const char damage : {'9', '-', '"', ']', 'x'}) {
      std::string text = good;
      text[i] = damage;
      const auto read = read_predictor(text);
      if (!read) continue;
      for (std::size_t j = 0; j < kJointCount; ++j) {
        const auto error = predicted_error(*read, static_cast<JointId>(j), {});
        EXPECT_TRUE(!error || (*error >= 0.001 && *error <= 1.0)) << text;
      }
    }
    EXPECT_FALSE(read_predictor(good.substr(0, i))) << i;  // without its end
  }
}

/// A file of version 1 stays readable.
TEST(ErrorFile, ReadsTheFileOfTheTests) {
  const auto read = load_predictor("tests/unit/learn/head_model.json");
  ASSERT_TRUE(read) << to_string(read.error());
  fusion::Features features{};
  features[static_cast<std::size_t>(fusion::Feature::Turn)] = 2.0;
  features[static_cast<std::size_t>(fusion::Feature::Distance)] = 3.0;
  EXPECT_NEAR(predicted_error(*read->model, Head, features).value(),
              std::exp(-4.0 + 0.5 * 2.0 + 0.1 * 3.0), 1e-12);
}

TEST(ErrorFile, NamesTheFileThatIsMissing) {
  const auto missing = load_predictor("no/such/model.json");
  ASSERT_FALSE(missing);
  EXPECT_THAT(to_string(missing.error()), HasSubstr("no/such/model.json"));
}

}  // namespace
}  // namespace chorus::learn
