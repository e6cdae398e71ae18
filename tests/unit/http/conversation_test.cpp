// Requests, answers and publications in any order, without a socket and without waiting.
#include "common/http/conversation.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/http/conversation_rig.h"

namespace chorus::http {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using namespace std::chrono_literals;

constexpr std::string_view kGet = "GET /frame HTTP/1.1\r\nHost: localhost\r\n\r\n";
constexpr std::string_view kPoll =
    "GET /frame HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=9\r\nIf-None-Match: \"1-txt\"\r\n\r\n";
constexpr std::string_view kStream =
    "GET /frame HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n\r\n";
constexpr std::string_view kPost =
    "POST /do HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n\r\n";

std::size_t times(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos;
       at = text.find(part, at + part.size()))
    ++count;
  return count;
}

TEST_F(ConversationTest, AHeadMayComeByteByByte) {
  begin();
  EXPECT_TRUE(talk_->idle());
  for (const char& c : kGet) {
    EXPECT_EQ(heard(), "");
    say({&c, 1});
  }
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200 OK\r\n"));
  EXPECT_TRUE(talk_->idle());
}

TEST_F(ConversationTest, RequestsSentAheadAreAnsweredInOrder) {
  begin();
  say(std::string(kGet) + std::string(kPost) + "hi" + std::string(kGet));
  const std::string all = heard();
  EXPECT_EQ(times(all, "HTTP/1.1 200 OK"), 3u);
  EXPECT_LT(all.find("\r\n\r\n1HTTP"), all.find("\r\n\r\nhiHTTP"));
  EXPECT_FALSE(closed_);
}

TEST_F(ConversationTest, ARequestSentAheadWaitsWhileAnAnswerIsWritten) {
  begin();
  stalled_ = true;
  say(kGet);
  EXPECT_TRUE(writing_);
  EXPECT_FALSE(reading_) << "what is sent ahead stays in the kernel";
  stalled_ = false;
  finish_write();
  EXPECT_TRUE(reading_);
}

TEST_F(ConversationTest, ConnectionCloseEndsItAfterTheAnswer) {
  begin();
  say("GET /vital HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
  EXPECT_THAT(heard(), HasSubstr("Connection: close\r\n"));
  EXPECT_TRUE(half_closed_);
  EXPECT_FALSE(closed_) << "what the client still sends is read first";
  obey(talk_->input_ended(true, now_));
  EXPECT_TRUE(closed_);
}

TEST_F(ConversationTest, HttpOneZeroIsClosedUnlessItAsks) {
  begin();
  say("GET /vital HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  EXPECT_THAT(heard(), HasSubstr("Connection: keep-alive\r\n"));
  say("GET /vital HTTP/1.0\r\n\r\n");
  EXPECT_THAT(heard(), HasSubstr("Connection: close\r\n"));
  EXPECT_TRUE(half_closed_);
}

TEST_F(ConversationTest, HeadsThatAreTooLongOrNoHeadsAreRefusedAndEndIt) {
  const auto answer_to = [this](const std::string& bytes) {
    talk_ = std::make_unique<Conversation>(
        ConversationContext{config_, *responder_, counters_, stopping_}, Peer{},
        [](const std::string&) { return true; });
    reading_ = false;
    begin();
    say(bytes);
    return heard();
  };
  EXPECT_THAT(answer_to("GET /" + std::string(300, 'a')), StartsWith("HTTP/1.1 414"));
  EXPECT_THAT(answer_to("GET / HTTP/1.1\r\nA: " + std::string(300, 'a')),
              StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(answer_to("hello\n"), StartsWith("HTTP/1.1 400"));
  EXPECT_EQ(counters_.refused.load(), 3u);
  EXPECT_EQ(counters_.requests.load(), 0u);
  EXPECT_TRUE(half_closed_);
}

TEST_F(ConversationTest, WhoGoesOnTalkingAfterARefusalIsCutOff) {
  begin();
  say("hello\n");
  for (int i = 0; i < 5000 && !closed_; ++i) say(std::string(256, 'x'));
  EXPECT_TRUE(closed_);
}

TEST_F(ConversationTest, ABodyIsReadHoweverItIsCut) {
  begin();
  say(kPost);
  EXPECT_EQ(heard(), "");
  say("h");
  say("i");
  EXPECT_THAT(heard(), HasSubstr("\r\n\r\nhi"));
}

TEST_F(ConversationTest, ABodyThatIsHeldBackIsAskedFor) {
  begin();
  say("POST /do HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\nExpect: 100-continue\r\n\r\n");
  EXPECT_EQ(heard(), "HTTP/1.1 100 Continue\r\n\r\n");
  say("hi");
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200 OK"));
  EXPECT_EQ(counters_.requests.load(), 1u);
}

TEST_F(ConversationTest, ABodyThatDoesNotComeIsNotWaitedForLong) {
  begin();
  say(kPost);
  pass(config_.limits.body_timeout);
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 408"));
  EXPECT_TRUE(half_closed_);
}

TEST_F(ConversationTest, SilenceBetweenRequestsEndsItWithoutAWord) {
  begin();
  say(kGet);
  (void)heard();
  pass(config_.limits.idle_timeout - 1s);
  EXPECT_FALSE(closed_);
  pass(1s);
  EXPECT_TRUE(closed_);
  EXPECT_EQ(heard(), "");
}

TEST_F(ConversationTest, HalfAHeadIsNotWaitedForLong) {
  begin();
  say("GET /");
  pass(config_.limits.header_timeout);
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 408"));
}

TEST_F(ConversationTest, WhoDoesNotReadIsCutOff) {
  begin();
  stalled_ = true;
  say(kGet);
  pass(config_.limits.write_timeout);
  EXPECT_TRUE(closed_);
}

TEST_F(ConversationTest, ALongPollIsAnsweredByThePublish) {
  publish(1);
  frame_->publish(make_document("text/plain", "x", {"1"}));
  begin();
  say(kPoll);
  EXPECT_TRUE(waiting_);
  EXPECT_EQ(heard(), "");
  EXPECT_EQ(counters_.long_polls_waiting.load(), 1u);
  frame_->publish(make_document("text/plain", "y", {"2"}));
  wake();
  EXPECT_THAT(heard(), HasSubstr("\r\n\r\ny"));
  EXPECT_FALSE(waiting_);
  EXPECT_EQ(counters_.long_polls_waiting.load(), 0u);
}

TEST_F(ConversationTest, APublishJustBeforeTheWaitIsNotMissed) {
  frame_->publish(make_document("text/plain", "x", {"1"}));
  publish_before_look_ = true;
  begin();
  say(kPoll);
  EXPECT_THAT(heard(), HasSubstr("\r\n\r\n9"));
  EXPECT_FALSE(waiting_);
}

TEST_F(ConversationTest, ALongPollEndsInVainOrWithTheServer) {
  frame_->publish(make_document("text/plain", "x", {"1"}));
  begin();
  say(kPoll);
  wake();
  EXPECT_TRUE(waiting_) << "woken by a publish of the same version";
  pass(9s);
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 304"));
  EXPECT_FALSE(waiting_);
  say(kPoll);
  stopping_ = true;
  obey(talk_->stop(now_));
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 503"));
  EXPECT_TRUE(half_closed_);
}

TEST_F(ConversationTest, AClientThatLeavesWhileItWaitsIsForgotten) {
  frame_->publish(make_document("text/plain", "x", {"1"}));
  begin();
  say(kPoll);
  EXPECT_TRUE(reading_) << "or nobody would notice";
  obey(talk_->input_ended(true, now_));
  EXPECT_TRUE(closed_);
  EXPECT_FALSE(waiting_);
  EXPECT_EQ(counters_.long_polls_waiting.load(), 0u);
}

TEST_F(ConversationTest, AStreamCarriesEveryVersionAndSkipsForASlowReader) {
  begin();
  say(kStream);
  EXPECT_THAT(heard(), HasSubstr("id: 1\ndata: 1\n\n"));
  publish(2);
  wake();
  EXPECT_EQ(heard(), "id: 2\ndata: 2\n\n");
  stalled_ = true;
  for (const int version : {3, 4, 5}) {
    publish(version);
    wake();
  }
  EXPECT_EQ(counters_.events_skipped.load(), 1u);
  stalled_ = false;
  finish_write();
  if (settling_) settle();
  EXPECT_EQ(heard(), "id: 3\ndata: 3\n\nid: 5\ndata: 5\n\n");
}

TEST_F(ConversationTest, AStreamTakesTheVersionForWhichAllAreWoken) {
  begin();
  say(kStream);
  (void)heard();
  publish(2);
  const DocumentPtr second = frame_->current();
  publish(3);
  (void)talk_->woken(now_);
  const Orders orders = talk_->look(now_, second);
  EXPECT_TRUE(orders.at_once) << "an event is sent without a wait where that is possible";
  obey(orders);
  EXPECT_EQ(heard(), "id: 2\ndata: 2\n\n");
  obey(talk_->look(now_));
  EXPECT_EQ(heard(), "id: 3\ndata: 3\n\n");
}

TEST_F(ConversationTest, AStreamOfASlowRateSendsTheNewestWhenItIsTime) {
  begin();
  say("GET /frame?max_rate=1 HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n\r\n");
  EXPECT_THAT(heard(), HasSubstr("id: 1\ndata: 1\n\n"));
  for (const int version : {2, 3}) {
    publish(version);
    wake();
  }
  EXPECT_EQ(heard(), "");
  pass(1s);
  EXPECT_EQ(heard(), "id: 3\ndata: 3\n\n");
  pass(14s);
  EXPECT_EQ(heard(), "") << "the heartbeat counts from there";
  pass(1s);
  EXPECT_EQ(heard(), ":\n\n");
}

TEST_F(ConversationTest, AStreamOfAnUnknownFormOrRateIsRefused) {
  begin();
  for (const char* query : {"max_rate=0", "form=prose"}) {
    say(std::string("GET /frame?") + query +
        " HTTP/1.1\r\nHost: localhost\r\nAccept: text/event-stream\r\n\r\n");
    EXPECT_THAT(heard(), HasSubstr("HTTP/1.1 4")) << query;
  }
}

TEST_F(ConversationTest, AStreamThatHasNothingToSayShowsThatItIsThere) {
  begin();
  say(kStream);
  (void)heard();
  pass(15s);
  EXPECT_EQ(heard(), ":\n\n");
  obey(talk_->close(now_));
  EXPECT_EQ(counters_.event_streams_open.load(), 0u);
}

TEST_F(ConversationTest, BeyondTheLimitOnlyWhatIsVitalIsAnswered) {
  obey(talk_->begin_in_reserve(now_));
  EXPECT_FALSE(talk_->idle());
  say("GET /vital HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_THAT(heard(), HasSubstr("\r\n\r\nwell"));
  EXPECT_TRUE(half_closed_);
}

TEST_F(ConversationTest, AProxysClientCountsForItself) {
  Peer proxy{true, "127.0.0.1", 80};
  proxy.proxy = true;
  room_for_others_ = false;
  talk_ = std::make_unique<Conversation>(
      ConversationContext{config_, *responder_, counters_, stopping_}, proxy,
      [this](const std::string& account) { return account == "192.0.2.1" || room_for_others_; });
  begin();
  const std::string of = "Host: localhost\r\nX-Forwarded-For: ";
  say("GET /frame HTTP/1.1\r\n" + of + "192.0.2.1\r\n\r\n");
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200"));
  say("GET /vital HTTP/1.1\r\n" + of + "192.0.2.2\r\n\r\n");
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200"));
  say("GET /frame HTTP/1.1\r\n" + of + "192.0.2.2\r\n\r\n");
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 503"));
}

TEST_F(ConversationTest, AWebSocketIsHandedOverWithWhatHasBeenRead) {
  const std::string open =
      "GET /frame HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nCookie: cc\r\n\r\n";
  begin();
  say(open + "frames");
  EXPECT_TRUE(upgraded_);
  const std::string handshake = talk_->handshake();
  EXPECT_THAT(handshake, StartsWith("GET / HTTP/1.1\r\n"));
  EXPECT_THAT(handshake, HasSubstr("Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"));
  EXPECT_THAT(handshake, EndsWith("\r\n\r\nframes"));
  EXPECT_THAT(handshake, Not(HasSubstr("Cookie"))) << "Beast takes 1536 bytes, frames included";
  EXPECT_NE(talk_->reaction().entry, nullptr);
  obey(talk_->expired(now_ + 1h));
  EXPECT_FALSE(closed_) << "it is no concern of the conversation any more";
}

}  // namespace
}  // namespace chorus::http
