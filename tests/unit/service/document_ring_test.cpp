// Recent frames by number and by instant.
#include "common/service/document_ring.h"

#include <gtest/gtest.h>

#include "common/resource/frame_between.h"
#include "common/resource/frame_document.h"
#include "tests/support/builders.h"

namespace chorus::service {
namespace {

using testing::kFrameInterval;
using testing::kStart;

using resource::FramePtr;
using resource::FrameResource;

const DocumentHistory kTenFrames{kFrameInterval * 10};

FramePtr frame_of(const Document& document) {
  return std::static_pointer_cast<const FrameResource>(document.value);
}

std::shared_ptr<const void> midway(const void* before, const void* after, Timestamp instant) {
  return std::make_shared<const FrameResource>(
      resource::between(*static_cast<const FrameResource*>(before),
                        *static_cast<const FrameResource*>(after), instant));
}

/// A ring of frames.
struct FrameRing : DocumentRing {
  explicit FrameRing(const DocumentHistory& history)
      : DocumentRing(history, {"frame", "frames/", "frame", midway}) {}
  void push(const FramePtr& frame) { DocumentRing::push(resource::document_of_value(frame)); }
  void amend(const FramePtr& frame) { DocumentRing::amend(resource::document_of_value(frame)); }
  [[nodiscard]] Result<FramePtr> find(std::string_view sequence) const {
    return DocumentRing::find(sequence).map(frame_of);
  }
  [[nodiscard]] Result<FramePtr> at(const std::string& time) const {
    return DocumentRing::at(time).map(frame_of);
  }
  [[nodiscard]] FramePtr newest() const { return frame_of(DocumentRing::newest()); }
};

FramePtr frame(std::uint64_t sequence) {
  auto f = std::make_shared<resource::FrameResource>();
  f->sequence = sequence;
  f->captured = kStart + kFrameInterval * static_cast<int>(sequence);
  f->source = "fusion";
  f->bodies.resize(1);
  f->bodies[0].joints[0].state = JointState::Tracked;
  f->bodies[0].joints[0].position.x() = static_cast<double>(sequence);
  return f;
}

struct Filled : FrameRing {
  Filled(std::uint64_t from, std::uint64_t to) : FrameRing(kTenFrames) {
    for (auto i = from; i <= to; ++i) push(frame(i));
  }
};

TEST(FrameRing, IsEmptyAtFirst) {
  const FrameRing ring(kTenFrames);
  EXPECT_EQ(ring.newest(), nullptr);
  EXPECT_EQ(ring.find("1").error().code, ErrorCode::NotFound);
  EXPECT_EQ(ring.at(to_iso8601(kStart)).error().code, ErrorCode::NotFound);
}

TEST(FrameRing, KnowsWhatIsHereWhatIsGoneAndWhatIsNotYet) {
  const Filled ring(1, 25);
  EXPECT_EQ((*ring.find("16"))->sequence, 16u);
  EXPECT_EQ((*ring.find("25"))->sequence, 25u);
  EXPECT_EQ(ring.find("15").error().code, ErrorCode::Gone);
  EXPECT_EQ(ring.find("26").error().code, ErrorCode::NotFound);
}

TEST(FrameRing, AFrameHasOneNameOnly) {
  const Filled ring(1, 10);
  for (const char* name :
       {"", "07", "+7", " 7", "7 ", "-7", "7.0", "x", "99999999999999999999999"}) {
    EXPECT_EQ(ring.find(name).error().code, ErrorCode::NotFound) << name;
  }
}

TEST(FrameRing, IsBoundedByNumberToo) {
  FrameRing ring({std::chrono::hours(1), 3});
  for (std::uint64_t i = 1; i <= 5; ++i) ring.push(frame(i));
  EXPECT_EQ(ring.find("2").error().code, ErrorCode::Gone);
  EXPECT_EQ((*ring.find("3"))->sequence, 3u);
}

TEST(FrameRing, ASkippedSequenceHasNeverBeen) {
  FrameRing ring(kTenFrames);
  ring.push(frame(2));
  ring.push(frame(5));
  const auto skipped = ring.find("3");
  ASSERT_FALSE(skipped);
  EXPECT_EQ(skipped.error().code, ErrorCode::NotFound);
  EXPECT_EQ(skipped.error().message.find("oldest"), std::string::npos);
  const auto evicted = ring.find("1");
  ASSERT_FALSE(evicted);
  EXPECT_EQ(evicted.error().code, ErrorCode::Gone);
  EXPECT_NE(evicted.error().message.find("still here is 2"), std::string::npos);
}

TEST(FrameRing, AnswersForAnInstantInEitherSpelling) {
  const Filled ring(1, 10);
  const Timestamp instant = kStart + kFrameInterval * 4 + kFrameInterval / 2;
  for (const std::string& text : {to_iso8601(instant), std::to_string(to_unix_ns(instant))}) {
    const auto found = ring.at(text);
    ASSERT_TRUE(found) << text;
    EXPECT_EQ((*found)->captured, instant);
    EXPECT_NEAR((*found)->bodies.at(0).joints[0].position.x(), 4.5, 1e-6);
  }
  EXPECT_EQ((*ring.at(to_iso8601(kStart + kFrameInterval * 4)))->sequence, 4u);
  const std::int64_t third = to_unix_ns(kStart + kFrameInterval * 3);
  for (const std::int64_t off : {-240, 240}) {
    const auto found = ring.at(std::to_string(third + off));
    ASSERT_TRUE(found) << off;
    EXPECT_EQ((*found)->captured, kStart + kFrameInterval * 3) << "as from seconds in a double";
  }
}

TEST(FrameRing, InstantsOutsideAreRefusedByKind) {
  const Filled ring(5, 10);
  EXPECT_EQ(ring.at(to_iso8601(kStart)).error().code, ErrorCode::Gone);
  EXPECT_EQ(ring.at(to_iso8601(kStart + std::chrono::hours(1))).error().code, ErrorCode::NotFound);
  for (const char* text : {"", "yesterday", "12:30", "1e9", "99999999999999999999999"}) {
    EXPECT_EQ(ring.at(text).error().code, ErrorCode::InvalidArgument) << text;
  }
}

TEST(FrameRing, AClockSetBackEmptiesIt) {
  Filled ring(1, 10);
  auto earlier = std::make_shared<resource::FrameResource>(*frame(11));
  earlier->captured = kStart - std::chrono::hours(1);
  ring.push(earlier);
  EXPECT_EQ(ring.newest()->sequence, 11u);
  EXPECT_EQ(ring.find("10").error().code, ErrorCode::Gone);
}

TEST(DocumentRing, SaysWhichKindIsNotThereAndInterpolatesOnlyWhatItCan) {
  DocumentRing ring(kTenFrames, {"orientations", "orientations/", "document", nullptr});
  EXPECT_EQ(ring.find("1").error().context, "/orientations/1");
  ring.push(resource::document_of_value(frame(1)));
  ring.push(resource::document_of_value(frame(3)));
  const auto between = ring.at(to_iso8601(frame(2)->captured));
  ASSERT_TRUE(between);
  EXPECT_EQ(between->sequence, 1u) << "the one before";
  EXPECT_EQ(ring.at("yesterday").error().context, "/orientations?at=yesterday");
}

TEST(FrameRing, ABetterAnswerIsForWhoAsksByTimeAndNeverChangesAFrame) {
  Filled ring(1, 5);
  auto better = std::make_shared<resource::FrameResource>(*frame(3));
  better->bodies[0].joints[0].position.x() = 30.0;
  ring.amend(better);
  EXPECT_EQ(ring.amendments(), 1u);
  const auto by_time = ring.at(to_iso8601(frame(3)->captured));
  EXPECT_DOUBLE_EQ((*by_time)->bodies[0].joints[0].position.x(), 30.0);
  EXPECT_DOUBLE_EQ((*ring.find("3"))->bodies[0].joints[0].position.x(), 3.0);
  const auto between = ring.at(to_iso8601(frame(3)->captured + kFrameInterval / 2));
  EXPECT_NEAR((*between)->bodies[0].joints[0].position.x(), 17.0, 0.01);
  ring.amend(frame(77));  // this frame is not in the ring
  EXPECT_EQ(ring.amendments(), 1u);
}

}  // namespace
}  // namespace chorus::service
