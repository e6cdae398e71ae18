#include "common/http/token_tries.h"

#include <gtest/gtest.h>

namespace chorus::http {
namespace {

constexpr TokenTries::Time kStart{std::chrono::hours(1)};

/// How many of `asked` different wrong tokens, evenly spread over `time`, were checked.
int looked_at(TokenTries& tries, int asked, std::chrono::milliseconds time) {
  int looked = 0;
  for (int i = 0; i < asked; ++i) {
    const auto now = kStart + time * i / asked;
    const std::string guess = "Bearer " + std::to_string(i);
    if (!tries.may_try("192.0.2.1", guess, now)) continue;
    ++looked;
    tries.note_wrong("192.0.2.1", guess, now);
  }
  return looked;
}

TEST(TokenTries, TenAtOnceThenOneASecond) {
  TokenTries tries;
  EXPECT_EQ(looked_at(tries, 5000, std::chrono::milliseconds(1)), 10);
  TokenTries patient;
  EXPECT_EQ(looked_at(patient, 60'000, std::chrono::seconds(60)), 10 + 59);
}

TEST(TokenTries, AMistakeNowAndThenIsNeverHeldUp) {
  TokenTries tries;
  EXPECT_EQ(looked_at(tries, 100, std::chrono::seconds(100)), 100);
}

TEST(TokenTries, OneAddressDoesNotHoldUpAnother) {
  TokenTries tries;
  looked_at(tries, 20, std::chrono::milliseconds(1));
  EXPECT_FALSE(tries.may_try("192.0.2.1", "Bearer right", kStart));
  EXPECT_TRUE(tries.may_try("192.0.2.2", "Bearer right", kStart));
  EXPECT_TRUE(tries.may_try("192.0.2.1", "Bearer right", kStart + std::chrono::seconds(2)));
}

TEST(TokenTries, OneOutdatedTokenForEverDoesNotHoldUpTheRightOne) {
  TokenTries tries;
  for (int i = 0; i < 5000; ++i) {
    const auto now = kStart + i * std::chrono::milliseconds(7);
    ASSERT_TRUE(tries.may_try("192.0.2.1", "Bearer outdated", now));
    tries.note_wrong("192.0.2.1", "Bearer outdated", now);
    ASSERT_TRUE(tries.may_try("192.0.2.1", "Bearer right", now)) << i;
  }
}

TEST(TokenTries, ARepeatedWrongTokenIsStillAnsweredWhileGuessesAreNot) {
  TokenTries tries;
  tries.note_wrong("192.0.2.1", "Bearer outdated", kStart);
  looked_at(tries, 20, std::chrono::milliseconds(1));
  EXPECT_TRUE(tries.may_try("192.0.2.1", "Bearer outdated", kStart));
  EXPECT_FALSE(tries.may_try("192.0.2.1", "Bearer 19", kStart));
}

TEST(TokenTries, ManyAddressesShareOneAccountInTheEnd) {
  TokenTries tries;
  for (int i = 0; i < 5000; ++i) {
    const std::string each = std::to_string(i);
    tries.note_wrong("host " + each, "Bearer " + each, kStart);
  }
  EXPECT_FALSE(tries.may_try("one more", "Bearer right", kStart));
  EXPECT_TRUE(tries.may_try("one more", "Bearer right", kStart + std::chrono::hours(1)));
}

}  // namespace
}  // namespace chorus::http
