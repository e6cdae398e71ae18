#include "common/base/nearest.h"

#include <array>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace chorus {
namespace {

TEST(Levenshtein, KnownDistances) {
  EXPECT_EQ(levenshtein("", ""), 0u);
  EXPECT_EQ(levenshtein("", "abc"), 3u);
  EXPECT_EQ(levenshtein("kitten", "sitting"), 3u);
  EXPECT_EQ(levenshtein("port", "prot"), 2u);
  EXPECT_EQ(levenshtein("max_gap_ms", "max_gap_s"), 1u);
}

std::string random_word(std::mt19937& random) {
  std::string word(random() % 7, 'a');
  for (char& c : word) c = static_cast<char>('a' + random() % 3);
  return word;
}

TEST(Levenshtein, IsADistance) {
  std::mt19937 random(7);
  for (int i = 0; i < 500; ++i) {
    const std::array words{random_word(random), random_word(random), random_word(random)};
    const std::size_t direct = levenshtein(words[0], words[1]);
    EXPECT_EQ(direct, levenshtein(words[1], words[0]));
    EXPECT_EQ(direct == 0, words[0] == words[1]);
    EXPECT_LE(direct, levenshtein(words[0], words[2]) + levenshtein(words[2], words[1]));
  }
}

TEST(Nearest, FindsWhatWasMeantAndNothingElse) {
  const std::vector<std::string> known{"port", "max_gap_ms", "latency_ms", "id"};
  EXPECT_EQ(nearest("prot", known), "port");
  EXPECT_EQ(nearest("max_gap", known), "max_gap_ms");
  EXPECT_EQ(nearest("latency_s", known), "latency_ms");
  EXPECT_EQ(nearest("if", known), "id");
  EXPECT_EQ(nearest("colour", known), "");
  EXPECT_EQ(nearest("xy", known), "");
  EXPECT_EQ(nearest("", known), "");
  EXPECT_EQ(nearest(std::string(100'000, 'p'), known), "");
  EXPECT_EQ(nearest("port", {}), "");
}

}  // namespace
}  // namespace chorus
