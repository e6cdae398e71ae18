// Clients that break the rules, by mistake or on purpose: each gets a clear answer or is
// disconnected, no other client is affected, and no request is ambiguous.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <vector>

#include "tests/integration/http/raw_client.h"
#include "tests/integration/http/test_server.h"

namespace chorus::http::test {
namespace {

using testing::HasSubstr;

constexpr std::string_view kGood = "GET /frame HTTP/1.1\r\nHost: localhost\r\n\r\n";

class HostileTest : public testing::Test {
 protected:
  static ServerConfig impatient() {
    ServerConfig config;
    config.limits.idle_timeout = std::chrono::seconds(2);
    config.limits.header_timeout = std::chrono::seconds(1);
    config.limits.body_timeout = std::chrono::seconds(1);
    config.limits.write_timeout = std::chrono::seconds(1);
    return config;
  }
  void SetUp() override { service_.frame->publish(frame_document(1)); }
  /// Whatever happened, other clients are served.
  void TearDown() override { EXPECT_EQ(service_.ask("/frame").status, 200); }

  std::uint16_t port() const { return service_.server.port(); }
  /// Sends the request and returns the answer up to the end of input, which must come.
  std::string refused(std::string_view request) {
    RawClient client(port());
    client.say(request);
    const std::string answer = client.hear_all();
    EXPECT_TRUE(client.ended()) << request.substr(0, 100);
    return answer;
  }

  TestServer service_{impatient()};
};

struct Refused {
  std::string name;
  std::string request;
  int status;
};

std::vector<Refused> refused_requests() {
  const std::string get = "GET /frame HTTP/1.1\r\n";
  const std::string post = "POST /registration HTTP/1.1\r\nHost: 127.0.0.1\r\n";
  return {
      {"length and coding",
       post + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400},
      {"coding and length",
       post + "Transfer-Encoding: chunked\r\nContent-Length: 5\r\n\r\n0\r\n\r\n", 400},
      {"two hosts", get + "Host: a\r\nHost: b\r\n\r\n", 400},
      {"twice the same host", get + "Host: a\r\nHost: a\r\n\r\n", 400},
      {"no host", get + "Accept: */*\r\n\r\n", 400},
      {"empty host", get + "Host:\r\n\r\n", 400},
      {"host with path", get + "Host: a/b\r\n\r\n", 400},
      {"host with user", get + "Host: u@a\r\n\r\n", 400},
      {"folded line", get + "Host: a\r\nAccept: text/turtle,\r\n application/json\r\n\r\n", 400},
      {"bare line feed", get + "Host: a\n\n", 400},
      {"bare line feed in the first line", "GET /frame HTTP/1.1\nHost: a\r\n\r\n", 400},
      {"bare carriage return", get + "Host: a\rb: c\r\n\r\n", 400},
      {"gzip coding", post + "Transfer-Encoding: gzip\r\n\r\n", 501},
      {"chunked then identity", post + "Transfer-Encoding: chunked, identity\r\n\r\n0\r\n\r\n",
       501},
      {"two codings in two lines",
       post + "Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n\r\n0\r\n\r\n", 501},
      {"chunked", post + "Transfer-Encoding: chunked\r\n\r\n1\r\nx\r\n0\r\n\r\n", 411},
      {"chunked in 1.0",
       "POST /registration HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", 400},
      {"foreign host in the target",
       "GET http://evil.example/ HTTP/1.1\r\nHost: evil.example\r\n\r\n", 421},
      {"target and host differ", "GET http://localhost/ HTTP/1.1\r\nHost: other\r\n\r\n", 400},
      {"authority form", "CONNECT evil.example:443 HTTP/1.1\r\nHost: a\r\n\r\n", 501},
      {"lowercase method", "get /frame HTTP/1.1\r\nHost: a\r\n\r\n", 501},
      {"HTTP/2 preface", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 505},
      {"HTTP/0.9", "GET /frame\r\n\r\n", 400},
      {"HTTP/1.2", "GET /frame HTTP/1.2\r\nHost: a\r\n\r\n", 505},
      {"space before the colon", get + "Host : a\r\n\r\n", 400},
      {"line without a colon", get + "Host: a\r\nnothing\r\n\r\n", 400},
      {"NUL in a value", get + "Host: a\r\nX: " + std::string(1, '\0') + "\r\n\r\n", 400},
      {"space in the target", "GET /a b HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"non-ASCII target", "GET /\xC3\xA4 HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"fragment in the target", "GET /frame#Head HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"body on GET", get + "Host: a\r\nContent-Length: 3\r\n\r\nabc", 400},
      {"length with a sign", post + "Content-Length: +3\r\n\r\nabc", 400},
      {"length as a list", post + "Content-Length: 3, 3\r\n\r\nabc", 400},
      {"two lengths", post + "Content-Length: 3\r\nContent-Length: 3\r\n\r\nabc", 400},
      {"length beyond 64 bits", post + "Content-Length: 99999999999999999999\r\n\r\n", 400},
      {"length beyond the limit", post + "Content-Length: 99999999\r\n\r\nabc", 413},
      {"unknown expectation", post + "Expect: miracles\r\nContent-Length: 1\r\n\r\nx", 417},
      {"connection without words", get + "Host: a\r\nConnection: kee@p-alive\r\n\r\n", 400},
      {"empty line first", "\r\nGET /frame HTTP/1.1\r\nHost: a\r\n\r\n", 400},
      {"TLS client hello", "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\n", 400},
      {"huge target", "GET /" + std::string(20000, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n", 414},
      {"huge field", get + "Host: a\r\nX: " + std::string(20000, 'a') + "\r\n\r\n", 431},
      {"many fields",
       get + "Host: a\r\n" +
           [] {
             std::string many;
             for (int i = 0; i < 100; ++i) many += "X-" + std::to_string(i) + ": 1\r\n";
             return many;
           }() +
           "\r\n",
       431},
  };
}

TEST_F(HostileTest, IsRefusedWithAReasonAndCutOff) {
  for (const Refused& c : refused_requests()) {
    const std::string answer = refused(c.request + std::string(kGood));
    EXPECT_EQ(status_in(answer), c.status) << c.name << "\n" << answer;
    EXPECT_EQ(times(answer, "Test-Clock: "), 1u) << c.name << ": nothing after it may be answered";
    EXPECT_THAT(answer, HasSubstr("Connection: close")) << c.name;
    EXPECT_THAT(answer, HasSubstr("application/problem+json")) << c.name;
    EXPECT_THAT(answer, HasSubstr("\"detail\":\"")) << c.name;
  }
}

TEST_F(HostileTest, AcceptedOddities) {
  const std::string own = "127.0.0.1:" + std::to_string(port());
  for (const std::string& request :
       {"GET http://" + own + "/frame HTTP/1.1\r\nHost: " + own + "\r\n\r\n",
        "GET HTTP://" + own + "/frame HTTP/1.1\r\nHost: " + own + "\r\n\r\n",
        std::string("GET /frame HTTP/1.1\r\nhOsT:\t localhost \t\r\nX:\r\n\r\n"),
        std::string("GET /%66rame?a HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n")}) {
    RawClient client(port());
    client.say(request);
    EXPECT_EQ(status_in(client.hear_until(".\n")), 200) << request;
  }
}

TEST_F(HostileTest, SlowLorisIsCutOff) {
  RawClient client(port());
  const auto start = std::chrono::steady_clock::now();
  client.say("GET /frame HTTP/1.1\r\n");
  std::string answer;
  for (int i = 0; i < 100 && !client.ended(); ++i) {
    client.say("X: 1\r\n");
    answer += client.hear_until("}", std::chrono::milliseconds(100));
  }
  EXPECT_EQ(status_in(answer), 408);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
}

TEST_F(HostileTest, SilentClientsAreClosed) {
  RawClient client(port());
  EXPECT_EQ(client.hear_all(), "");
  EXPECT_TRUE(client.ended());
}

TEST_F(HostileTest, HalfRequestsAndHalfBodies) {
  RawClient half(port());
  half.say(kGood.substr(0, 10));
  half.finish_sending();
  EXPECT_EQ(half.hear_all(), "");
  EXPECT_TRUE(half.ended());
  const std::string body =
      "POST /registration HTTP/1.1\r\nHost: localhost\r\nContent-Length: 10\r\n\r\nabc";
  EXPECT_EQ(status_in(refused(body)), 408);
}

TEST_F(HostileTest, OneByteAtATime) {
  RawClient client(port());
  for (const char byte : kGood) ASSERT_TRUE(client.say({&byte, 1}));
  EXPECT_EQ(status_in(client.hear_until(".\n")), 200);
}

TEST_F(HostileTest, EverySplitOfARequestIsTheSameRequest) {
  RawClient client(port());
  for (std::size_t cut = 1; cut < kGood.size(); ++cut) {
    ASSERT_TRUE(client.say(kGood.substr(0, cut)));
    ASSERT_TRUE(client.say(kGood.substr(cut)));
    ASSERT_EQ(status_in(client.hear_until(".\n")), 200) << cut;
  }
}

TEST_F(HostileTest, TenThousandPipelinedRequestsAreAnsweredInOrder) {
  constexpr int kRequests = 10000;
  RawClient client(port());
  std::string requests;
  for (int i = 0; i < kRequests; ++i)
    requests += "GET /frames/" + std::to_string(i) + " HTTP/1.1\r\nHost: localhost\r\n" +
                (i + 1 == kRequests ? "Connection: close\r\n\r\n" : "\r\n");
  std::thread sender([&] { client.say(requests); });
  const std::string answers = client.hear_all(std::chrono::seconds(60));
  sender.join();
  ASSERT_TRUE(client.ended());
  ASSERT_EQ(times(answers, "HTTP/1.1 200 OK"), static_cast<std::size_t>(kRequests));
  std::size_t at = 0;
  for (int i = 0; i < kRequests; ++i) {
    at = answers.find("ETag: \"" + std::to_string(i) + "-txt\"", at);
    ASSERT_NE(at, std::string::npos) << i;
  }
}

TEST_F(HostileTest, AClientThatNeverReadsIsClosed) {
  RawClient client(port(), 4096);
  std::string requests;
  for (int i = 0; i < 100; ++i) requests += "GET /big HTTP/1.1\r\nHost: localhost\r\n\r\n";
  client.say(requests);
  // While this client hangs, others are served; then the write deadline frees its connection.
  EXPECT_EQ(service_.ask("/frame").status, 200);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (service_.server.counters().connections_open > 0 &&
         std::chrono::steady_clock::now() < deadline)
    std::this_thread::yield();
  EXPECT_EQ(service_.server.counters().connections_open, 0u);
}

TEST_F(HostileTest, ConnectionCloseAndHttp10AreHonoured) {
  EXPECT_EQ(
      status_in(refused("GET /frame HTTP/1.1\r\nHost: localhost\r\nConnection: Close\r\n\r\n")),
      200);
  EXPECT_EQ(status_in(refused("GET /frame HTTP/1.0\r\n\r\n")), 200);
  RawClient kept(port());
  for (int i = 0; i < 2; ++i) {
    kept.say("GET /frame HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
    const std::string answer = kept.hear_until(".\n");
    EXPECT_EQ(status_in(answer), 200);
    EXPECT_THAT(answer, HasSubstr("Connection: keep-alive"));
  }
}

TEST_F(HostileTest, RunningOutOfDescriptorsDoesNotEndTheServer) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "runs without AddressSanitizer, which needs a descriptor itself";
#endif
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  RawClient waits_in_the_backlog(port());
  // Leave no descriptor: accept() fails with EMFILE until some are closed.
  const int highest = ::open("/dev/null", O_RDONLY);
  ASSERT_GE(highest, 0);
  const rlimit none{static_cast<rlim_t>(highest), before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  std::vector<int> fillers;
  for (int fd = ::dup(highest); fd >= 0; fd = ::dup(highest)) fillers.push_back(fd);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  ASSERT_GE(socket, 0);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port());
  EXPECT_EQ(::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  // The server tries to accept meanwhile.
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
  for (const int fd : fillers) ::close(fd);
  ::close(highest);
  EXPECT_EQ(::send(socket, kGood.data(), kGood.size(), 0), static_cast<ssize_t>(kGood.size()));
  char first[12] = {};
  EXPECT_EQ(::recv(socket, first, sizeof first, MSG_WAITALL), 12);
  EXPECT_EQ(std::string_view(first, 12), "HTTP/1.1 200");
  ::close(socket);
}

TEST_F(HostileTest, ContinueIsSaidBeforeTheBodyIsRead) {
  RawClient client(port());
  client.say(
      "POST /registration HTTP/1.1\r\nHost: localhost\r\nExpect: 100-continue\r\n"
      "Content-Length: 2\r\n\r\n");
  EXPECT_EQ(client.hear_until("\r\n\r\n"), "HTTP/1.1 100 Continue\r\n\r\n");
  client.say("go");
  EXPECT_EQ(status_in(client.hear_until(".\n")), 201);
  EXPECT_EQ(service_.last_body, "go");
}

TEST_F(HostileTest, ABodyIsNeverTakenForARequest) {
  RawClient client(port());
  const std::string inner(kGood);
  client.say("POST /registration HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
             std::to_string(inner.size()) + "\r\n\r\n" + inner +
             "GET /frame HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(times(client.hear_all(), "HTTP/1.1 "), 2u);
  EXPECT_EQ(service_.last_body, inner);
}

}  // namespace
}  // namespace chorus::http::test
