#include "common/http/token_tries.h"

#include <gtest/gtest.h>

#include <vector>

namespace chorus::http {
namespace {

constexpr TokenTries::Time kStart{std::chrono::hours(1)};

/// The delay of the answer to each of `asked` different wrong tokens, evenly spread over `time`.
std::vector<double> delays(TokenTries& tries, int asked, std::chrono::milliseconds time) {
  std::vector<double> all;
  for (int i = 0; i < asked; ++i) {
    const std::string guess = "Bearer " + std::to_string(i);
    all.push_back(seconds(tries.note_wrong("192.0.2.1", guess, kStart + time * i / asked)));
  }
  return all;
}

TEST(TokenTries, TenAtOnceThenOneASecondAndNoneForEver) {
  TokenTries tries;
  const auto of = delays(tries, 30, std::chrono::milliseconds(1));
  for (int i = 0; i < 10; ++i) EXPECT_EQ(of[static_cast<std::size_t>(i)], 0.0) << i;
  EXPECT_NEAR(of[10], 1.0, 0.01);
  EXPECT_NEAR(of[11], 2.0, 0.01);
  EXPECT_NEAR(of[29], 5.0, 0.01);
}

TEST(TokenTries, AMistakeNowAndThenIsNeverHeldUp) {
  TokenTries tries;
  for (const double each : delays(tries, 100, std::chrono::seconds(100))) EXPECT_EQ(each, 0.0);
}

TEST(TokenTries, OneAddressDoesNotHoldUpAnother) {
  TokenTries tries;
  (void)delays(tries, 20, std::chrono::milliseconds(1));
  EXPECT_GT(tries.note_wrong("192.0.2.1", "Bearer x", kStart), Duration{0});
  EXPECT_EQ(tries.note_wrong("192.0.2.2", "Bearer x", kStart), Duration{0});
}

TEST(TokenTries, AWrongTokenThatIsRepeatedIsAnsweredAtOnce) {
  TokenTries tries;
  (void)tries.note_wrong("192.0.2.1", "Bearer outdated", kStart);
  (void)delays(tries, 14, std::chrono::milliseconds(1));
  EXPECT_EQ(tries.note_wrong("192.0.2.1", "Bearer outdated", kStart), Duration{0});
  EXPECT_GT(tries.note_wrong("192.0.2.1", "Bearer another", kStart), Duration{0});
}

TEST(TokenTries, ManyAddressesShareOneAccountInTheEnd) {
  TokenTries tries;
  for (int i = 0; i < 5000; ++i) {
    const std::string each = std::to_string(i);
    (void)tries.note_wrong("host " + each, "Bearer " + each, kStart);
  }
  EXPECT_GT(tries.note_wrong("one more", "Bearer x", kStart), Duration{0});
  EXPECT_EQ(tries.note_wrong("one more", "Bearer y", kStart + std::chrono::hours(1)), Duration{0});
}

}  // namespace
}  // namespace chorus::http
