#include "fusion-server/journal/witness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::journal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::kStart;
using testing::sensor_id;

SensorStatus sensor(const char* id, const char* state, const char* error = "") {
  SensorStatus one;
  one.id = sensor_id(id);
  one.state = state;
  one.last_error = error;
  return one;
}

Glimpse quiet() {
  Glimpse now;
  now.time = kStart;
  now.sensors = {sensor("s1", "live"), sensor("s2", "live")};
  now.outputs = {{"vrpn", "", {}}};
  now.disk_free = 1e9;
  now.disk_least = 2e8;
  return now;
}

std::vector<std::string> kinds(const std::vector<Event>& events) {
  std::vector<std::string> all;
  for (const Event& event : events) {
    all.push_back(event.kind);
    EXPECT_NE(std::ranges::find(kinds_of_events(), event.kind), kinds_of_events().end());
    EXPECT_TRUE(event.severity == Severity::Calm || !event.advice.empty())
        << event.kind << " says what to do";
  }
  return all;
}

/// What a witness of quiet() says of this glimpse.
std::vector<Event> told(const Glimpse& next, const Glimpse& before = quiet()) {
  Witness witness;
  (void)witness.compare(before);
  auto events = witness.compare(next);
  EXPECT_THAT(witness.compare(next), IsEmpty()) << "once";
  return events;
}

TEST(Witness, TellsNothingWhereNothingHappens) {
  Witness witness;
  EXPECT_THAT(witness.compare(quiet()), IsEmpty());
  EXPECT_THAT(witness.compare(quiet()), IsEmpty());
  EXPECT_THAT(witness.compare({}), IsEmpty()) << "sensors taken out by a reload";
}

TEST(Witness, SeesSensorsComeAndGo) {
  Glimpse lost = quiet();
  lost.sensors[0] = sensor("s1", "lost", "connection refused");
  const auto events = told(lost);
  ASSERT_THAT(kinds(events), ElementsAre("sensor-lost"));
  EXPECT_EQ(events[0].about, "s1");
  EXPECT_EQ(events[0].severity, Severity::Warning);
  EXPECT_EQ(events[0].message, "s1 delivers nothing: connection refused.");
  EXPECT_THAT(kinds(told(quiet(), lost)), ElementsAre("sensor-back"));
  Glimpse starting = quiet();
  starting.sensors[0].state = "connecting";
  EXPECT_THAT(kinds(told(quiet(), starting)), ElementsAre("sensor-live"));
  Witness witness;
  EXPECT_THAT(kinds(witness.compare(lost)), ElementsAre("sensor-lost")) << "from the beginning";
}

TEST(Witness, SeesThatASensorWasMovedWhateverTheSentence) {
  Glimpse moved = quiet();
  moved.sensors[1].alarm = "s2 was moved by about 0.3 m 5 s ago; walk through the room";
  const auto events = told(moved);
  ASSERT_THAT(kinds(events), ElementsAre("sensor-moved"));
  EXPECT_EQ(events[0].message, "s2 was moved by about 0.3 m 5 s ago.");
  EXPECT_EQ(events[0].advice, "walk through the room");
  Glimpse later = moved;
  later.sensors[1].alarm = "s2 was moved by about 0.3 m 6 s ago; walk through the room";
  EXPECT_THAT(told(later, moved), IsEmpty());
  EXPECT_THAT(kinds(told(quiet(), moved)), ElementsAre("sensor-in-place"));
}

TEST(Witness, SeesOnceThatASensorIsContradicted) {
  Glimpse contested = quiet();
  contested.sensors[1].contested =
      "s2 sees somebody at (1.0, 0.0) m, where s1 looks and sees nobody";
  const auto events = told(contested);
  ASSERT_THAT(kinds(events), ElementsAre("sensor-contested"));
  EXPECT_EQ(events[0].about, "s2");
  Glimpse later = contested;
  later.sensors[1].contested = "s2 sees somebody at (1.1, 0.0) m, where s1 looks and sees nobody";
  EXPECT_THAT(told(later, contested), IsEmpty());
}

TEST(Witness, FollowsTheRegistration) {
  Glimpse walking = quiet();
  SessionStatus session;
  session.id = 5;
  session.state = SessionState::Solving;
  walking.sessions = {session};
  Glimpse done = walking;
  done.sessions[0].state = SessionState::Done;
  done.sessions[0].adopted = true;
  done.registration.version = 1;
  done.registration.solved = kStart;
  done.registration.verdict = Verdict::Good;
  done.registration.sensors[sensor_id("s1")] = {};
  EXPECT_THAT(kinds(told(done, walking)), ElementsAre("registration-adopted", "verdict-changed"));
  Glimpse turned = done;
  turned.registration.version = 2;
  EXPECT_THAT(kinds(told(turned, done)), ElementsAre("registration-replaced"));
  Glimpse worse = done;
  worse.registration.verdict = Verdict::Provisional;
  worse.registration.reasons = {"s2 was moved"};
  const auto events = told(worse, done);
  ASSERT_THAT(kinds(events), ElementsAre("verdict-changed"));
  EXPECT_EQ(events[0].severity, Severity::Warning);
  EXPECT_THAT(events[0].message, HasSubstr("is Provisional, it was Good: s2 was moved."));
  Glimpse refused = walking;
  refused.sessions[0].state = SessionState::Done;
  refused.sessions[0].reasons = {"nobody walked"};
  EXPECT_THAT(kinds(told(refused, walking)), ElementsAre("registration-not-adopted"));
  refused.proposal = true;
  EXPECT_THAT(kinds(told(refused, walking)), ElementsAre("registration-proposed"));
  Glimpse unstored = quiet();
  unstored.storage_trouble = "no space left";
  EXPECT_THAT(kinds(told(unstored)), ElementsAre("registration-not-stored"));
}

TEST(Witness, CountsTheClientsOfOutputs) {
  Glimpse two = quiet();
  two.outputs[0].counters.clients = 2;
  EXPECT_THAT(kinds(told(two)), ElementsAre("output-client-came"));
  const auto lost = told(quiet(), two);
  ASSERT_THAT(kinds(lost), ElementsAre("output-client-lost"));
  EXPECT_EQ(lost[0].message, "vrpn has 0 clients, it had 2.");
  Glimpse failed = quiet();
  failed.outputs[0].error = "the port is taken";
  EXPECT_THAT(kinds(told(failed)), ElementsAre("output-failed"));
  EXPECT_THAT(kinds(told(quiet(), failed)), ElementsAre("output-open"));
}

TEST(Witness, WatchesRecordingsAndTheirDisk) {
  Glimpse runs = quiet();
  runs.recording = RecordingGlimpse{"r1", "", true};
  EXPECT_THAT(kinds(told(runs)), ElementsAre("recording-started"));
  Glimpse ended = runs;
  ended.recording->running = false;
  EXPECT_THAT(kinds(told(ended, runs)), ElementsAre("recording-stopped"));
  ended.recording->trouble = "the disk is full";
  EXPECT_THAT(kinds(told(ended, runs)), ElementsAre("recording-failed"));
  EXPECT_THAT(kinds(told(ended)), ElementsAre("recording-started", "recording-failed")) << "short";
  Glimpse full = quiet();
  full.disk_free = 3e8;
  Witness witness;
  (void)witness.compare(quiet());
  EXPECT_THAT(kinds(witness.compare(full)), ElementsAre("disk-nearly-full"));
  full.disk_free = 4.5e8;
  EXPECT_THAT(witness.compare(full), IsEmpty()) << "not again and again around the limit";
  EXPECT_THAT(kinds(witness.compare(quiet())), ElementsAre("disk-has-room"));
}

TEST(Witness, TellsOnceWhoWasShownAsSomebodyElse) {
  Glimpse one = quiet();
  one.people = {KnownPerson{}};
  one.people[0].id = {7};
  Glimpse corrected = one;
  const Timestamp now = corrected.time;
  corrected.people[0].correction = {PersonId{3}, {7}, now - std::chrono::milliseconds(1500), now};
  const auto events = told(corrected, one);
  ASSERT_THAT(kinds(events), ElementsAre("person-corrected"));
  EXPECT_EQ(events[0].about, "7");
  EXPECT_EQ(events[0].message, "Person 7 was shown as person 3 for 1.5 s.");
  EXPECT_THAT(told(corrected, corrected), IsEmpty());
}

TEST(Witness, GreetsPeople) {
  Glimpse one = quiet();
  one.people = {KnownPerson{}};
  one.people[0].id = {7};
  EXPECT_EQ(told(one)[0].message, "Person 7 came.");
  Glimpse left = one;
  left.people[0].name = "Anna";
  left.people[0].presence = Presence::Left;
  const auto events = told(left, one);
  ASSERT_THAT(kinds(events), ElementsAre("person-left"));
  EXPECT_EQ(events[0].message, "Anna (person 7) left.");
  EXPECT_EQ(events[0].about, "7");
  EXPECT_THAT(kinds(told(one, left)), ElementsAre("person-back"));
  EXPECT_THAT(told(quiet(), left), IsEmpty()) << "struck off the roll";
}

}  // namespace
}  // namespace chorus::journal
