#include "common/net/address.h"

#include <gtest/gtest.h>

namespace chorus::net {
namespace {

std::string account(const char* text) { return account_of(asio::ip::make_address(text)); }

TEST(AccountOf, IsTheAddressOrTheNetOfAnIpv6Host) {
  EXPECT_EQ(account("192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(account("::ffff:192.0.2.7"), "192.0.2.7");
  EXPECT_EQ(account("::1"), "::1");
  EXPECT_EQ(account("2001:db8:1:2:3:4:5:6"), account("2001:db8:1:2:ffff::1"));
  EXPECT_NE(account("2001:db8:1:2::1"), account("2001:db8:1:3::1"));
}

}  // namespace
}  // namespace chorus::net
