// Who asks too much, or guesses tokens, waits; nobody else does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/http/token_tries.h"
#include "tests/unit/http/conversation_rig.h"

namespace chorus::http {
namespace {

using ::testing::StartsWith;

class Allowed : public ConversationTest {};

TEST_F(Allowed, WhoAsksTooMuchWaitsAndIsNotRefused) {
  net::AddressAllowance allowance(net::Allowance{10.0, 2.0});
  Peer stranger{false, "192.0.2.9", 80};
  stranger.account = "192.0.2.1";
  talk_ = std::make_unique<Conversation>(
      ConversationContext{config_, *responder_, counters_, stopping_, &allowance}, stranger,
      [](const std::string&) { return true; });
  begin();
  const std::string request = "GET /vital HTTP/1.1\r\nHost: 192.0.2.9\r\n\r\n";
  for (int i = 0; i < 2; ++i) {
    say(request);
    EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200"));
  }
  say(request);
  EXPECT_EQ(heard(), "") << "the third of two at once";
  EXPECT_EQ(counters_.held, 1u);
  now_ += std::chrono::milliseconds(50);
  obey(talk_->expired(now_));
  EXPECT_EQ(heard(), "");
  EXPECT_EQ(counters_.held, 1u) << "counted once";
  now_ += std::chrono::milliseconds(60);
  obey(talk_->expired(now_));
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200"));
}

TEST_F(Allowed, ProgramsOnThisHostAreLimitedOnlyBehindAProxy) {
  net::AddressAllowance allowance(net::Allowance{1.0, 1.0});
  const auto second_answered = [&] {
    Peer local{true, "127.0.0.1", 80};
    local.account = "127.0.0.1";
    talk_ = std::make_unique<Conversation>(
        ConversationContext{config_, *responder_, counters_, stopping_, &allowance}, local,
        [](const std::string&) { return true; });
    reading_ = false;
    begin();
    const std::string request = "GET /vital HTTP/1.1\r\nHost: localhost\r\n\r\n";
    say(request);
    (void)heard();
    say(request);
    return !heard().empty();
  };
  EXPECT_TRUE(second_answered());
  config_.trusted_proxies = {"192.0.2.7"};
  EXPECT_FALSE(second_answered());
}

TEST_F(Allowed, TheAnswerToAWrongGuessWaits) {
  config_.bearer_token = "the right one";
  auto router = std::make_shared<Router>();
  router->action(Method::Post, "/do", [](const Request&, const PathParams&) {
    return Result<ActionResult>(ActionResult{200, make_document("text/plain", "done", {"1"})});
  });
  responder_ = std::make_unique<Responder>(config_, router);
  talk_ = std::make_unique<Conversation>(
      ConversationContext{config_, *responder_, counters_, stopping_}, Peer{true, "127.0.0.1", 80},
      [](const std::string&) { return true; });
  begin();
  const auto ask = [this](const std::string& token) {
    say("POST /do HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\nAuthorization: Bearer " +
        token + "\r\n\r\n");
  };
  for (int i = 0; i < 10; ++i) {
    ask("guess " + std::to_string(i));
    ASSERT_THAT(heard(), StartsWith("HTTP/1.1 401"));
  }
  ask("the right one");
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 200"));
  ask("one more");
  EXPECT_EQ(heard(), "");
  now_ += TokenTries::kLongestDelay;
  obey(talk_->expired(now_));
  EXPECT_THAT(heard(), StartsWith("HTTP/1.1 401"));
}

TEST(AddressAllowance, IsEachAddressesOwnUntilThereAreTooMany) {
  net::AddressAllowance allowance({1.0, 1.0});
  const SteadyTime now{std::chrono::hours(1)};
  EXPECT_TRUE(allowance.take("a", now));
  EXPECT_FALSE(allowance.take("a", now));
  EXPECT_TRUE(allowance.take("b", now));
  for (std::size_t i = 2; i < net::AddressAllowance::kMostAddresses; ++i)
    (void)allowance.take("host " + std::to_string(i), now);
  EXPECT_TRUE(allowance.take("one more", now));
  EXPECT_FALSE(allowance.take("and another", now)) << "those beyond share one allowance";
  EXPECT_TRUE(allowance.take("and another", now + std::chrono::seconds(2))) << "all forgotten";
}

}  // namespace
}  // namespace chorus::http
