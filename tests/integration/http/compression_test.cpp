// Compressed bodies: made once, distinguished by tags, and sent only to clients that accept them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using ::testing::HasSubstr;

constexpr std::string_view kMagic("\x1f\x8b", 2);
const Header kGzip{"Accept-Encoding", "gzip, deflate"};

DocumentPtr long_document(int n) {
  return std::make_shared<const Document>(
      std::vector<Variant>{{"application/json",
                            [n] {
                              return "{\"n\":" + std::to_string(n) + ",\"x\":\"" +
                                     std::string(5000, 'x') + "\"}";
                            }}},
      DocumentOptions{std::to_string(n)});
}

TEST(Compression, OnlyForWhoAsks) {
  TestServer service;
  service.frame->publish(long_document(1));
  const auto plain = service.ask("/frame");
  EXPECT_FALSE(plain.headers.contains("content-encoding"));
  const auto coded = service.ask("/frame", {kGzip});
  EXPECT_EQ(coded.headers.at("content-encoding"), "gzip");
  EXPECT_EQ(coded.headers.at("content-type"), plain.headers.at("content-type"));
  EXPECT_EQ(coded.body.substr(0, 2), kMagic);
  EXPECT_LT(coded.body.size() * 10, plain.body.size());
  for (const auto& answer : {plain, coded})
    EXPECT_THAT(answer.headers.at("vary"), HasSubstr("Accept-Encoding"));
}

TEST(Compression, EachCodingHasItsOwnTag) {
  TestServer service;
  service.frame->publish(long_document(1));
  const auto ask = [&](const std::string& tag, bool gzip) {
    std::vector<Header> headers{{"If-None-Match", tag}};
    if (gzip) headers.push_back(kGzip);
    return service.ask("/frame", headers);
  };
  EXPECT_EQ(ask("\"0\"", true).headers.at("etag"), "\"1-json-gz\"");
  EXPECT_EQ(ask("\"0\"", false).headers.at("etag"), "\"1-json\"");
  const auto unchanged = ask("\"1-json-gz\"", true);
  EXPECT_EQ(unchanged.status, 304);
  EXPECT_EQ(unchanged.headers.at("etag"), "\"1-json-gz\"");
  EXPECT_EQ(ask("\"1-json\"", true).status, 200) << "strong tags: those are other bytes";
  EXPECT_EQ(ask("\"1-json-gz\"", false).status, 200);
  EXPECT_EQ(ask("\"1-json\"", false).status, 304);
}

TEST(Compression, HeadTellsTheLengthOfGet) {
  TestServer service;
  service.frame->publish(long_document(1));
  const auto get = service.ask("/frame", {kGzip});
  const auto head = service.ask("/frame", {kGzip}, "HEAD");
  EXPECT_EQ(head.headers.at("content-length"), std::to_string(get.body.size()));
  EXPECT_EQ(head.headers.at("etag"), get.headers.at("etag"));
}

TEST(Compression, ShortBodiesStayAsTheyAre) {
  TestServer service;
  service.frame->publish(frame_document(1));
  EXPECT_FALSE(service.ask("/frame", {kGzip}).headers.contains("content-encoding"));
}

TEST(Compression, LongPollsGetTheNext) {
  TestServer service;
  service.frame->publish(long_document(1));
  RawClient client(service.server.port());
  client.say(
      "GET /frame HTTP/1.1\r\nHost: localhost\r\nAccept-Encoding: gzip\r\n"
      "Prefer: wait=10\r\nIf-None-Match: \"1-json-gz\"\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(client.hear_some(std::chrono::milliseconds(300)), "") << "it waits";
  service.frame->publish(long_document(2));
  const std::string answer = client.hear_all();
  EXPECT_EQ(status_in(answer), 200);
  EXPECT_THAT(answer, HasSubstr("ETag: \"2-json-gz\""));
}

TEST(Compression, EventStreamsAreOneGzipFile) {
  TestServer service;
  service.frame->publish(long_document(1));
  RawClient client(service.server.port());
  client.say(
      "GET /frame HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n"
      "Accept-Encoding: gzip\r\n\r\n");
  const std::string begin =
      client.hear_until(*long_document(1)->event("application/json", {}, Coding::Gzip));
  EXPECT_THAT(begin, HasSubstr("Content-Encoding: gzip\r\n"));
  EXPECT_THAT(begin,
              HasSubstr("\r\n\r\n" + std::string(gzip_begin()) + gzip_piece("retry: 1000\n\n")));
  service.frame->publish(long_document(2));
  const std::string piece = *long_document(2)->event("application/json", {}, Coding::Gzip);
  EXPECT_EQ(client.hear_until(piece), piece);
}

}  // namespace
}  // namespace chorus::http::test
