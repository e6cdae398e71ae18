#include "common/ergonomics/task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::ergonomics {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal(std::string_view text) {
  const auto task = read_task(text, "task.json");
  return task ? "accepted" : to_string(task.error());
}

TEST(TaskFile, PhasesOverrideWhatHoldsForTheWhole) {
  const auto task = read_task(R"({"title": "Battery", "loadKg": 1, "coupling": "good", // a comment
    "phases": [{"name": "lift", "fromSeconds": 4, "toSeconds": 9, "loadKg": 12}]})",
                              "task.json");
  ASSERT_TRUE(task) << to_string(task.error());
  EXPECT_EQ(*task->asked_at(3.0).load_kg, 1.0);
  EXPECT_EQ(*task->asked_at(4.0).load_kg, 12.0);
  EXPECT_EQ(*task->asked_at(9.0).load_kg, 1.0);
  EXPECT_EQ(task->asked_at(5.0).coupling, Coupling::Good);
  EXPECT_FALSE(task->asked_at(5.0).shock);
}

TEST(TaskFile, RefusalsNameThePlaceAndWhatToDo) {
  EXPECT_THAT(refusal(R"({"loadKg": 981})"),
              AllOf(HasSubstr("task.json.loadKg"), HasSubstr("100.0 kg")));
  EXPECT_THAT(refusal(R"({"loadkg": 3})"), HasSubstr("did you mean loadKg?"));
  EXPECT_THAT(refusal(R"({"loadKg": -3})"), HasSubstr("at least 0"));
  EXPECT_THAT(refusal(R"({"coupling": "soso"})"), HasSubstr("good, fair, poor, unacceptable"));
  EXPECT_THAT(refusal(R"({"shock": 1})"), HasSubstr("true or false"));
  EXPECT_THAT(refusal(R"({"phases": [{"fromSeconds": 5, "toSeconds": 4}]})"),
              HasSubstr("before it begins"));
  EXPECT_THAT(refusal(R"({"phases": [{"name": "a", "fromSeconds": 1, "toSeconds": 4},
                                     {"name": "b", "fromSeconds": 3, "toSeconds": 6}]})"),
              AllOf(HasSubstr("'a' (1 to 4 s)"), HasSubstr("overlap")));
  EXPECT_THAT(refusal("{"), HasSubstr("task.json"));
  EXPECT_THAT(
      refusal(
          R"({"lifts": [{"fromSeconds": 1, "toSeconds": 2, "loadKg": 3, "perMinute": 1, "hours": 1}]})"),
      HasSubstr("coupling"));
  EXPECT_THAT(
      refusal(R"({"eawsPoints": {"secondsPerMinute": [3, 5], "points": {"standing": [1]}}})"),
      HasSubstr("as many points"));
}

TEST(TaskFile, ReachesNotBeyondTheRecording) {
  const auto task =
      read_task(R"({"phases": [{"name": "lift", "fromSeconds": 4, "toSeconds": 9}]})", "t");
  EXPECT_TRUE(fits(*task, 9.0, "t"));
  EXPECT_THAT(fits(*task, 8.0, "t").error().message, HasSubstr("lasts 8.00 s"));
}

}  // namespace
}  // namespace chorus::ergonomics
