// Questions of who somebody is, asked of tracks that are made for it.
#include "fusion-server/associate/recognition.h"

#include <gtest/gtest.h>

#include "tests/support/builders.h"
#include "tests/unit/associate/somebody.h"

namespace chorus::associate {
namespace {

using testing::kFrameInterval;
using testing::kStart;

/// Somebody of this size: a person who has left if `gone`, otherwise one whom four sensors see now.
Candidate candidate(std::uint64_t id, double size, bool gone) {
  Candidate out;
  out.track.id = PersonId{id};
  out.track.hits = 100;
  out.track.found = gone ? kStart : kStart + std::chrono::seconds(10);
  out.track.seen = gone ? kStart + std::chrono::seconds(5) : kStart + std::chrono::seconds(15);
  out.track.placed = out.track.seen;
  out.track.admitted = out.track.named = gone;
  std::vector<PlacedView> views;
  for (int sensor = 0; sensor < 4; ++sensor)
    views.push_back({view_of_somebody({0.0, size}, sensor, 1)});
  out.track.build.add(spans_of(views, {}), out.track.found, 5.0);
  if (!gone) out.sights = views;
  return out;
}

constexpr Timestamp kNow = kStart + std::chrono::seconds(15);

TEST(Recognise, OfTwoAlikeWhoComeAtOnceOneIsTheLostPersonAndNobodyVanishes) {
  Tracks tracks;
  tracks.next_id = 10;
  std::vector<Candidate> candidates{candidate(1, 1.0, true), candidate(2, 1.0, false),
                                    candidate(3, 1.0, false)};
  recognise(candidates, tracks, {kNow, {}}, {});
  ASSERT_EQ(candidates.size(), 2u);
  EXPECT_EQ(candidates[0].track.id, PersonId{1});
  EXPECT_EQ(candidates[1].track.id, PersonId{3});
}

TEST(Recognise, OfTwoWhoComeAtOnceEachIsWhomBothTogetherFitBest) {
  Tracks tracks;
  tracks.next_id = 10;
  std::vector<Candidate> candidates{candidate(1, 1.0, true), candidate(2, 1.03, true),
                                    candidate(3, 1.012, false), candidate(4, 0.985, false)};
  recognise(candidates, tracks, {kNow, {}}, {});
  ASSERT_EQ(candidates.size(), 2u);
  EXPECT_EQ(candidates[0].track.id, PersonId{2}) << "although the first fits better";
  EXPECT_EQ(candidates[1].track.id, PersonId{1});
}

/// A track whose views were of `before` for 5 s and then, after a gap, of somebody of `size` for
/// `time` [s].
Candidate found_again(double before, double size, double time) {
  Candidate out = candidate(1, before, true);
  std::vector<PlacedView> views;
  for (int sensor = 0; sensor < 4; ++sensor)
    views.push_back({view_of_somebody({0.0, size}, sensor, 1)});
  out.track.build.cut(1.5);
  out.track.build.add(spans_of(views, {}), kNow, time);
  out.track.seen = out.track.placed = kNow;
  out.sights = views;
  return out;
}

TEST(Recognise, AnIdThatNobodyHasSeenIsNotMissed) {
  Tracks tracks;
  tracks.next_id = 10;
  std::vector<Candidate> candidates{found_again(1.0, 1.2, 2.0)};
  candidates[0].track.admitted = false;
  EXPECT_TRUE(recognise(candidates, tracks, {kNow, {}}, {}).empty()) << "and nothing is corrected";
  EXPECT_EQ(candidates[0].track.id, PersonId{10}) << "somebody else";
  EXPECT_TRUE(tracks.missing.empty()) << "it was never published";
}

TEST(Recognise, WhatWasWithheldAllTheTimeIsNotCorrected) {
  for (const bool withheld : {true, false}) {
    Tracks tracks;
    tracks.next_id = 10;
    std::vector<Candidate> candidates{found_again(1.0, 1.2, 2.0)};
    candidates[0].track.published = withheld ? kNow - std::chrono::seconds(10) : kNow;
    EXPECT_EQ(recognise(candidates, tracks, {kNow, {}}, {}).size(), withheld ? 0u : 1u);
    EXPECT_EQ(candidates[0].track.id, PersonId{10});
    EXPECT_FALSE(candidates[0].track.published) << "the new id was not published yet";
  }
}

TEST(Recognise, ASecondInViewIsLearnedOnceHoweverLongACameraAloneFollows) {
  Tracks tracks;
  tracks.next_id = 10;
  std::vector<Candidate> candidates{found_again(1.0, 1.0, 1.0)};
  recognise(candidates, tracks, {kNow, {}}, {});
  const double learned = tracks.repeatability.seconds;
  EXPECT_EQ(learned, Repeatability{}.seconds + 1.0);
  for (int i = 1; i < 90; ++i) {
    candidates[0].track.seen = kNow + i * kFrameInterval;
    recognise(candidates, tracks, {candidates[0].track.seen, {}}, {});
  }
  EXPECT_EQ(tracks.repeatability.seconds, learned);
}

/// A track under `id`, of somebody of size `before`, that now follows somebody of size `now`.
Candidate gone_over(std::uint64_t id, double before, double now, double time) {
  Candidate out = found_again(before, now, time);
  out.track.id = PersonId{id};
  return out;
}

TEST(Recognise, OfThreeWhoTookEachOthersPlaceNobodyVanishes) {
  // The last one is known well enough; the others give up their ids one after the other, against
  // the order of the tracks.
  Tracks tracks;
  tracks.next_id = 10;
  std::vector<Candidate> candidates{gone_over(1, 1.0, 1.16, 0.2), gone_over(2, 1.08, 1.0, 0.2),
                                    gone_over(3, 1.16, 1.08, 2.0)};
  recognise(candidates, tracks, {kNow, {}}, {});
  ASSERT_EQ(candidates.size(), 3u);
  EXPECT_EQ(candidates[0].track.id, PersonId{3});
  EXPECT_EQ(candidates[1].track.id, PersonId{1});
  EXPECT_EQ(candidates[2].track.id, PersonId{2});
  EXPECT_TRUE(tracks.missing.empty());
}

enum class Shown { AsBefore, NotAtAll, AsAnother };

/// How somebody of this size is published after a third of a second in view, where somebody of size
/// 1 was lost.
Shown shown_while_compared(double size) {
  Tracks tracks;
  tracks.next_id = 10;
  std::vector<Candidate> candidates{found_again(1.0, size, 0.33)};
  recognise(candidates, tracks, {kNow, {}}, {});
  if (candidates[0].track.id != PersonId{1}) return Shown::AsAnother;
  return candidates[0].track.withheld ? Shown::NotAtAll : Shown::AsBefore;
}

TEST(Recognise, WhoIsProbablySomebodyElseIsNotShownWhileBuildsAreCompared) {
  double size = 1.0;
  while (size < 1.2 && shown_while_compared(size) == Shown::AsBefore) size += 0.001;
  EXPECT_GT(size, 1.02);
  EXPECT_LT(size, 1.08);
  EXPECT_EQ(shown_while_compared(size), Shown::NotAtAll);
  while (size < 1.2 && shown_while_compared(size) == Shown::NotAtAll) size += 0.001;
  EXPECT_LT(size, 1.15);
  EXPECT_EQ(shown_while_compared(size), Shown::AsAnother);
}

}  // namespace
}  // namespace chorus::associate
