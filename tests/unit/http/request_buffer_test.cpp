#include "common/http/request_buffer.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

void fill(RequestBuffer& buffer, std::string_view bytes) {
  ASSERT_LE(bytes.size(), buffer.room().size());
  std::copy(bytes.begin(), bytes.end(), buffer.room().begin());
  buffer.add(bytes.size());
}

TEST(RequestBuffer, AHeadIsFoundHoweverItIsCut) {
  RequestBuffer buffer(64);
  fill(buffer, "GET / HTTP/1.1\r\n\r");
  EXPECT_EQ(buffer.find_head().progress, HeadProgress::Incomplete);
  fill(buffer, "\nGET");
  const HeadEnd head = buffer.find_head();
  EXPECT_EQ(head.progress, HeadProgress::Complete);
  EXPECT_EQ(head.size, 18u);
  buffer.drop(head.size);
  EXPECT_EQ(buffer.unread(), "GET");
  EXPECT_EQ(buffer.find_head().progress, HeadProgress::Incomplete);
}

TEST(RequestBuffer, ABodyIsTakenOutBehindItsHead) {
  RequestBuffer buffer(16);
  fill(buffer, "HEADbodyNEXT");
  std::string body;
  buffer.take_body(4, 3, body);
  buffer.take_body(4, 1, body);
  EXPECT_EQ(body, "body");
  EXPECT_EQ(buffer.unread(), "HEADNEXT");
  buffer.take_body(4, 9, body);
  EXPECT_EQ(body, "bodyNEXT") << "never more than there is";
}

TEST(RequestBuffer, CompactingMakesRoomAndKeepsWhatIsUnread) {
  RequestBuffer buffer(8);
  fill(buffer, "abcdefgh");
  EXPECT_TRUE(buffer.full());
  buffer.drop(6);
  EXPECT_TRUE(buffer.full());
  buffer.compact();
  EXPECT_EQ(buffer.unread(), "gh");
  EXPECT_EQ(buffer.room().size(), 6u);
  buffer.clear();
  EXPECT_EQ(buffer.room().size(), 8u);
}

}  // namespace
}  // namespace chorus::http
