#include "common/net/capacity.h"

#include <gtest/gtest.h>

namespace chorus::net {
namespace {

constexpr Capacity kTwoOfOne{3, 2, "server.max", "server.max_per_address"};

TEST(Capacity, ThereIsRoomBelowBothLimits) {
  EXPECT_EQ(objection(kTwoOfOne, {2, 1}, "192.0.2.7"), "");
}

TEST(Capacity, TheLimitThatIsReachedIsNamedWithItsKey) {
  EXPECT_EQ(objection(kTwoOfOne, {3, 0}, "192.0.2.7"),
            "there are 3 already, as many as server.max allows");
  EXPECT_EQ(objection(kTwoOfOne, {2, 2}, "192.0.2.7"),
            "there are 2 already of 192.0.2.7, as many as server.max_per_address allows");
}

}  // namespace
}  // namespace chorus::net
