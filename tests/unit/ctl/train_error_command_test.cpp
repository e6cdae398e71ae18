// chorus train-error, from recordings and a truth to a model that fusion takes.
#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "fusion-server/learn/error_file.h"
#include "services/ctl/calibrate/true_bodies.h"
#include "tests/unit/ctl/program_run.h"

namespace chorus::ctl {
namespace {

using chorus::testing::bytes_of;
using ::testing::HasSubstr;
using Json = nlohmann::json;

/// A cell that has its fused frames as truth and its places in files.
struct Trial {
  explicit Trial(double length) : cell(length) {
    EXPECT_EQ(run_chorus({"fuse", cell.recordings(), "--out", truth, "--save-registration", places,
                          "--method", "mean"})
                  .code,
              kExitOk);
  }
  [[nodiscard]] Outcome train(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{"train-error", cell.recordings(), "--truth", truth, "--out",
                                   model,         "--registration",  places};
    words.insert(words.end(), more.begin(), more.end());
    return run_chorus(words);
  }

  Cell cell;
  std::string truth = cell.file("truth.ndjson");
  std::string places = cell.file("places.json");
  std::string model = cell.file("model.json");
};

TEST(TrainErrorCommand, WritesAModelThatFusionTakes) {
  const Trial trial(21.0);  // three sensors: 63 s of views
  const Outcome done = trial.train({"--json"});
  ASSERT_EQ(done.code, kExitOk) << done.error;
  const Json summary = Json::parse(done.error);
  EXPECT_EQ(summary.at("joints"), 25);
  EXPECT_GT(summary.at("knownPercent"), 95);
  EXPECT_LT(summary.at("errorCm"), 1.0);  // these sensors err by rounding alone
  const auto model = learn::load_predictor(trial.model);
  ASSERT_THAT(model, chorus::testing::IsOk());
  EXPECT_EQ(model.value().model->kind, fusion::PredictorKind::Gamma);
  const std::vector<std::string> fuse{"fuse",     trial.cell.recordings(), "--out", "-",
                                      "--method", "inverse-variance"};
  std::vector<std::string> learned = fuse;
  learned.insert(learned.end(), {"--set", "fusion.errors=" + trial.model});
  EXPECT_NE(run_chorus(fuse).out, run_chorus(learned).out);
}

TEST(TrainErrorCommand, SaysWhatToRecordIfThereIsTooLittle) {
  const Trial trial(6.0);
  const Outcome refused = trial.train();
  EXPECT_EQ(refused.code, kExitFailed);
  EXPECT_THAT(refused.error, HasSubstr("17 s of views"));
  EXPECT_THAT(refused.error, HasSubstr("record several minutes"));
  EXPECT_FALSE(std::filesystem::exists(trial.model));
}

TEST(TrainErrorCommand, RefusesATruthOfAnotherPlaceOrNone) {
  const Trial trial(6.0);
  std::string moved;
  for (const std::string& line : lines_of(bytes_of(trial.truth))) {
    Json frame = Json::parse(line);
    for (Json& body : frame.at("bodies")) {
      for (Json& joint : body.at("joints")) {
        if (joint.contains("x")) joint["x"] = joint["x"].get<double>() + 2.0;
      }
    }
    moved += frame.dump() + "\n";
  }
  ASSERT_TRUE(replace_file(trial.truth, moved));
  EXPECT_THAT(trial.train().error, HasSubstr("in the same world"));
  std::filesystem::remove(trial.truth);
  EXPECT_THAT(trial.train().error, HasSubstr("truth.ndjson"));
}

TEST(TrainErrorCommand, NeverWritesOverItsInput) {
  const Trial trial(6.0);
  const std::string before = bytes_of(trial.truth);
  EXPECT_EQ(trial.train({"--out", trial.truth}).code, kExitUsage);  // --out twice
  EXPECT_EQ(run_chorus({"train-error", trial.cell.recordings(), "--truth", trial.truth, "--out",
                        trial.truth})
                .code,
            kExitFailed);
  EXPECT_EQ(bytes_of(trial.truth), before);
}

exporters::FusedSample head_at(Timestamp instant, std::uint64_t person, double x) {
  exporters::FusedSample sample{instant, PersonId{person}, {}};
  sample.skeleton[JointId::Head].position = {x, 1.6, 0.0};
  sample.skeleton[JointId::Head].state = JointState::Tracked;
  return sample;
}

TEST(TrueBodies, AreInterpolatedAndNeverAcrossGaps) {
  using std::chrono::milliseconds;
  const Timestamp start = chorus::testing::kStart;
  const TrueBodies truth({head_at(start, 1, 0.0), head_at(start + milliseconds(40), 1, 0.1),
                          head_at(start + milliseconds(400), 1, 0.2), head_at(start, 2, 0.4),
                          head_at(start + milliseconds(40), 2, 0.4)});
  Person person;
  person.views.emplace_back().skeleton = head_at(start, 1, 0.1).skeleton;
  const auto found = truth.at(start + milliseconds(10), person);
  ASSERT_TRUE(found);
  EXPECT_NEAR((*found)[JointId::Head].position.x(), 0.025, 1e-9);
  EXPECT_TRUE(truth.at(start + milliseconds(400), person));
  EXPECT_FALSE(truth.at(start + milliseconds(200), person));
  EXPECT_FALSE(truth.at(start - milliseconds(10), person));
  EXPECT_FALSE(truth.at(start + milliseconds(410), person));
  person.views.front().skeleton[JointId::Head].position.x() = 0.39;
  EXPECT_NEAR((*truth.at(start, person))[JointId::Head].position.x(), 0.4, 1e-9);
  person.views.front().skeleton[JointId::Head].position.x() = 1.0;
  EXPECT_FALSE(truth.at(start, person));
}

}  // namespace
}  // namespace chorus::ctl
