#include "common/http/answer.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

TEST(HttpDate, KnownInstants) {
  EXPECT_EQ(http_date(from_unix_ns(0)), "Thu, 01 Jan 1970 00:00:00 GMT");
  EXPECT_EQ(http_date(from_unix_ns(784111777'999'999'999)), "Sun, 06 Nov 1994 08:49:37 GMT");
  EXPECT_EQ(http_date(from_unix_ns(951782400'000'000'000)), "Tue, 29 Feb 2000 00:00:00 GMT");
}

std::string first_lines(const Answer& answer, const AnswerStamp& stamp) {
  std::string out;
  write_first_lines(out, answer, stamp);
  return out;
}

TEST(FirstLines, StatusAndDate) {
  EXPECT_EQ(first_lines({}, {from_unix_ns(1), from_unix_ns(2'000'000'000)}),
            "HTTP/1.1 200 OK\r\nDate: Thu, 01 Jan 1970 00:00:02 GMT\r\n");
}

TEST(FirstLines, TheOwnersClock) {
  EXPECT_EQ(first_lines({}, {.received = from_unix_ns(1),
                             .sent = from_unix_ns(2'000'000'000),
                             .clock_field = "Test-Clock"}),
            "HTTP/1.1 200 OK\r\nTest-Clock: 1 2000000000\r\n"
            "Date: Thu, 01 Jan 1970 00:00:02 GMT\r\n");
}

TEST(FirstLines, ConnectionAgeAndExtraLines) {
  Answer answer;
  answer.status = 304;
  answer.extra = "Preference-Applied: wait\r\n";
  answer.captured = from_unix_ns(1'000'000'000);
  EXPECT_EQ(first_lines(answer, {from_unix_ns(1), from_unix_ns(1'012'045'999), true}),
            "HTTP/1.1 304 Not Modified\r\n"
            "Date: Thu, 01 Jan 1970 00:00:01 GMT\r\nConnection: close\r\n"
            "Server-Timing: age;dur=12.045\r\nPreference-Applied: wait\r\n");
  AnswerStamp stamp{from_unix_ns(1), from_unix_ns(0), false, true};
  EXPECT_EQ(first_lines(answer, stamp),
            "HTTP/1.1 304 Not Modified\r\n"
            "Date: Thu, 01 Jan 1970 00:00:00 GMT\r\nConnection: keep-alive\r\n"
            "Server-Timing: age;dur=0.000\r\nPreference-Applied: wait\r\n")
      << "a capture in the future has age 0";
}

TEST(ReasonPhrase, UnknownCodesHaveOneToo) { EXPECT_EQ(reason_phrase(299), "Status"); }

}  // namespace
}  // namespace chorus::http
