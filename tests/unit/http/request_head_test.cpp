// What the head reader accepts.  tests/integration/http/hostile_test.cpp sends a server what it
// must refuse.
#include "common/http/request_head.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

RequestHead parsed(std::string_view bytes) {
  RequestHead head;
  const auto refusal = read_head(bytes, head);
  EXPECT_FALSE(refusal) << bytes << refusal->detail;
  return head;
}

int status_of(std::string_view bytes) {
  RequestHead head;
  const auto refusal = read_head(bytes, head);
  return refusal ? refusal->status : 200;
}

TEST(RequestHead, TakesTheRequestApart) {
  const std::string bytes =
      "POST /a/b?x=1&y HTTP/1.1\r\nHost: h:80\r\nAccept: text/turtle\r\naccept:\tapplication/json "
      "\r\nPrefer: wait=3\r\nContent-Length: 12\r\nX-Other: \xC3\xA4\r\n\r\n";
  const RequestHead head = parsed(bytes);
  EXPECT_EQ(head.method, Method::Post);
  EXPECT_EQ(head.path, "/a/b");
  EXPECT_EQ(head.query, "x=1&y");
  EXPECT_EQ(head.host, "h:80");
  EXPECT_EQ(head.accept, "text/turtle, application/json");
  EXPECT_EQ(head.prefer, "wait=3");
  EXPECT_EQ(head.content_length, 12u);
  EXPECT_TRUE(head.keep_alive);
  EXPECT_EQ(head.fields.size(), 6u);
  EXPECT_FALSE(is_present(head.if_none_match));
}

TEST(RequestHead, IsReusedWithoutMemory) {
  RequestHead head;
  EXPECT_FALSE(read_head("GET /a?b HTTP/1.0\r\nAccept: x\r\nAccept: y\r\n\r\n", head));
  EXPECT_FALSE(read_head("GET / HTTP/1.1\r\nHost: h\r\n\r\n", head));
  EXPECT_FALSE(is_present(head.accept));
  EXPECT_EQ(head.query, "");
  EXPECT_EQ(head.fields.size(), 1u);
  EXPECT_TRUE(head.joined.empty());
}

TEST(RequestHead, KeepAliveByVersionAndConnection) {
  const auto kept = [](const std::string& version, const std::string& lines) {
    return parsed("GET / HTTP/" + version + "\r\nHost: h\r\n" + lines + "\r\n").keep_alive;
  };
  EXPECT_TRUE(kept("1.1", ""));
  EXPECT_TRUE(kept("1.1", "Connection: upgrade\r\n"));
  EXPECT_FALSE(kept("1.1", "Connection: TE, Close\r\n"));
  EXPECT_FALSE(kept("1.1", "Connection: keep-alive\r\nConnection: close\r\n"));
  EXPECT_FALSE(kept("1.0", "Connection: close, keep-alive\r\n"));  // RFC 9112 9.3
  EXPECT_FALSE(kept("1.0", ""));
  EXPECT_TRUE(kept("1.0", "Connection: Keep-Alive\r\n"));
}

TEST(RequestHead, TargetForms) {
  const RequestHead absolute = parsed("GET http://h:1/x?q HTTP/1.1\r\nHost: H:1\r\n\r\n");
  EXPECT_EQ(absolute.authority, "h:1");
  EXPECT_EQ(absolute.path, "/x");
  EXPECT_EQ(absolute.query, "q");
  EXPECT_EQ(parsed("GET http://h HTTP/1.1\r\nHost: h\r\n\r\n").path, "/");
  EXPECT_TRUE(parsed("OPTIONS * HTTP/1.1\r\nHost: h\r\n\r\n").asterisk);
  for (const auto target : {"*", "x", "https://h/", "http:///", "http://u@h/", "", "/a\\b", "/\"",
                            "/<a>", "/a#b", "http://h?q"})
    EXPECT_EQ(status_of("GET " + std::string(target) + " HTTP/1.1\r\nHost: h\r\n\r\n"), 400)
        << target;
}

TEST(RequestHead, NeverReadsOutside) {
  RequestHead head;
  const std::string bytes = "GET / HTTP/1.1\r\nHost: h\r\nContent-Length: 3\r\nAccept: */*\r\n\r\n";
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    // A separate allocation, so that ASan detects reads past its end.
    const std::string cut = bytes.substr(0, size);
    (void)read_head(cut, head);
    (void)find_head_end(cut, 0);
  }
  for (const auto odd : {"\n", "\r\n", "\r\n\r\n", "\n\n", "\r", " \r\n\r\n", ":\r\n\r\n"})
    EXPECT_EQ(status_of(odd), 400);
}

TEST(HeadEnd, IsFoundWhereverReadingStopped) {
  const std::string bytes = "GET / HTTP/1.1\r\nHost: h\r\n\r\nbody\n";
  const std::size_t end = bytes.size() - 5;
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    for (std::size_t checked = 0; checked <= size && checked < end; ++checked) {
      const HeadEnd found = find_head_end(std::string_view(bytes).substr(0, size), checked);
      EXPECT_EQ(found.progress, size < end ? HeadProgress::Incomplete : HeadProgress::Complete);
      if (size >= end) {
        EXPECT_EQ(found.size, end);
      }
    }
  }
}

TEST(HeadEnd, BareLineFeedsBreakItAtOnce) {
  for (const auto bytes : {"\n", "GET / HTTP/1.1\n", "GET / HTTP/1.1\r\nHost: h\n", "a\r\n\n"})
    EXPECT_EQ(find_head_end(bytes, 0).progress, HeadProgress::Broken) << bytes;
}

}  // namespace
}  // namespace chorus::http
