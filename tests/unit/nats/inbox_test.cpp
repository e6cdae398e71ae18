#include "fusion-server/nats/inbox.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::nats {
namespace {

using ::testing::ElementsAre;

site::CellId speaker(const std::string& name) { return site::CellId::parse(name).value(); }

TEST(AnInbox, LetsATalkativeCellDisplaceItsOwnWordsOnly) {
  Inbox<int> inbox(3);
  inbox.give(speaker("quiet"), 7);
  for (int word = 100; word < 10'100; ++word) inbox.give(speaker("loud"), word);
  EXPECT_THAT(inbox.take(), ElementsAre(10'097, 10'098, 10'099, 7));
  EXPECT_EQ(inbox.dropped(), 9'997U);
  EXPECT_TRUE(inbox.take().empty());
}

TEST(AnInbox, HasRoomForSixtyFourCells) {
  Inbox<int> inbox(3);
  for (int cell = 0; cell < 100; ++cell) inbox.give(speaker(std::to_string(cell)), cell);
  EXPECT_EQ(inbox.take().size(), 64U);
  EXPECT_EQ(inbox.dropped(), 36U);
}

}  // namespace
}  // namespace chorus::nats
