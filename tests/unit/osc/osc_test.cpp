// OSC bytes: padding, type tags, big-endian numbers, bundles.
#include "fusion-server/osc/osc.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/osc/osc_reader.h"

namespace chorus::osc {
namespace {

std::string bytes_of(const Message& message) {
  const auto bytes = message.bytes();
  return {bytes.begin(), bytes.end()};
}

template <std::size_t kSize>
std::string literal(const char (&text)[kSize]) {
  return {text, kSize - 1};
}

TEST(Osc, AddressesOfThreeFourAndFiveAreClosedByOneToFourNuls) {
  EXPECT_EQ(bytes_of(Message("/ab")), literal("/ab\0,\0\0\0"));
  EXPECT_EQ(bytes_of(Message("/abc")), literal("/abc\0\0\0\0,\0\0\0"));
  EXPECT_EQ(bytes_of(Message("/abcd")), literal("/abcd\0\0\0,\0\0\0"));
}

TEST(Osc, NumbersAreBigEndian) {
  EXPECT_EQ(bytes_of(Message("/m").integer(-2).real(0.15625).text("abc")),
            literal("/m\0\0,ifs\0\0\0\0\xff\xff\xff\xfe\x3e\x20\0\0abc\0"));
}

TEST(Osc, NothingThatIsNotANumberIsSent) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto read =
      outlet::testing::OscReader(Message("/m").real(nan).real(1e300).bytes()).packet();
  EXPECT_EQ(read.at(0).numbers, (std::vector<double>{0, 0}));
}

TEST(Osc, AStringEndsAtItsFirstNul) {
  EXPECT_EQ(bytes_of(Message("/m").text(std::string_view("a\0bcd", 5))),
            literal("/m\0\0,s\0\0a\0\0\0"));
}

TEST(Osc, ABundleIsNoLongerThanItsLimitAndNothingIsLost) {
  Bundles bundles(100);
  for (int i = 0; i < 20; ++i) bundles.add(Message("/count").integer(i));
  std::vector<double> seen;
  for (const auto& bundle : bundles.all()) {
    EXPECT_LE(bundle.size(), 100u);
    EXPECT_GT(bundle.size(), 60u);
  }
  for (const auto& message : outlet::testing::read_osc(bundles.all())) {
    seen.push_back(message.numbers.at(0));
  }
  ASSERT_EQ(seen.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], i);
}

TEST(Osc, ABundleBeginsWithItsNameAndTheTimeNow) {
  Bundles bundles;
  bundles.add(Message("/a"));
  const auto& bytes = bundles.all().at(0);
  EXPECT_EQ(std::string(bytes.begin(), bytes.end()),
            literal("#bundle\0\0\0\0\0\0\0\0\1\0\0\0\x08/a\0\0,\0\0\0"));
}

}  // namespace
}  // namespace chorus::osc
