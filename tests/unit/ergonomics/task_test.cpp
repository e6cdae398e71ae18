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

/// Two lifts, the second of which the recording's end cuts off.
const Marks kMarks{{{0.0, "stand"}, {2.0, "lift"}, {3.5, "down"}, {6.0, "lift"}}, 8.0};

TEST(TaskFile, PhasesAreToldByMarks) {
  const auto task = read_task(R"({"stance": {"fromMark": "stand"},
      "phases": [{"fromMark": "lift", "toMark": "down", "loadKg": 12},
                 {"name": "rest", "fromMark": "down"}],
      "lifts": [{"fromMark": "lift", "loadKg": 12, "perMinute": 1, "hours": 1, "coupling": "fair"}]})",
                              "t", kMarks);
  ASSERT_TRUE(task) << to_string(task.error());
  ASSERT_EQ(task->phases.size(), 3U);
  EXPECT_EQ(task->phases[0].name, "lift") << "named after the mark";
  EXPECT_EQ(task->phases[0].span.from, 2.0);
  EXPECT_EQ(task->phases[0].span.to, 3.5);
  EXPECT_EQ(task->phases[1].name, "rest");
  EXPECT_EQ(task->phases[1].span.to, 6.0) << "without toMark until the next mark";
  EXPECT_EQ(task->phases[2].span.to, 8.0) << "until the recording's end";
  EXPECT_EQ(*task->asked_at(7.0).load_kg, 12.0);
  EXPECT_EQ(task->lifts.size(), 2U);
  EXPECT_EQ(task->lifts[1].span.from, 6.0);
  EXPECT_EQ(task->stance->to, 2.0);
  EXPECT_TRUE(fits(*task, 8.0, "t"));
}

TEST(TaskFile, MarksThatWereNotSetAreNamed) {
  const auto said = [](std::string_view text, const Marks& marks) {
    const auto task = read_task(text, "t", marks);
    return task ? "accepted" : to_string(task.error());
  };
  constexpr std::string_view kScrew = R"({"phases": [{"fromMark": "screw"}]})";
  EXPECT_THAT(said(kScrew, kMarks),
              AllOf(HasSubstr("t.phases[0].fromMark"), HasSubstr("'stand', 'lift', 'down'")));
  EXPECT_THAT(said(kScrew, {}), HasSubstr("it has none"));
  EXPECT_THAT(said(R"({"phases": [{"toMark": "lift"}]})", kMarks), HasSubstr("fromMark"));
  EXPECT_THAT(said(R"({"phases": [{"fromMark": "lift", "toSeconds": 3}]})", kMarks),
              HasSubstr("not by both"));
  EXPECT_THAT(said(R"({"phases": [{"fromMark": 3}]})", kMarks), HasSubstr("name of a mark"));
  EXPECT_THAT(said(R"({"phases": [{"fromMark": "lift"}]})", {{{9.0, "lift"}}, 8.0}),
              HasSubstr("outside the frames"));
}

TEST(TaskFile, ReachesNotBeyondTheRecording) {
  const auto task =
      read_task(R"({"phases": [{"name": "lift", "fromSeconds": 4, "toSeconds": 9}]})", "t");
  EXPECT_TRUE(fits(*task, 9.0, "t"));
  EXPECT_THAT(fits(*task, 8.0, "t").error().message, HasSubstr("lasts 8.00 s"));
}

}  // namespace
}  // namespace chorus::ergonomics
