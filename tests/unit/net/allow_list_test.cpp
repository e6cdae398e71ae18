#include "common/net/allow_list.h"

#include <gmock/gmock.h>

namespace chorus::net {
namespace {

using ::testing::HasSubstr;

bool allows(const std::vector<std::string>& entries, const char* address) {
  const auto list = AllowList::parse(entries);
  return list && list->allows(asio::ip::make_address(address));
}

TEST(AllowList, AnswersThisHostAndNobodyElseByDefault) {
  for (const char* own : {"127.0.0.1", "127.9.9.9", "::1", "::ffff:127.0.0.1"})
    EXPECT_TRUE(allows({}, own)) << own;
  for (const char* other : {"10.0.0.1", "192.168.1.1", "fe80::1", "::ffff:10.0.0.1", "::"})
    EXPECT_FALSE(allows({}, other)) << other;
}

TEST(AllowList, KnowsAddressesAndNetworks) {
  EXPECT_TRUE(allows({"10.0.0.20"}, "10.0.0.20"));
  EXPECT_TRUE(allows({"10.0.0.20"}, "::ffff:10.0.0.20")) << "through an IPv6 socket";
  EXPECT_FALSE(allows({"10.0.0.20"}, "10.0.0.21"));
  EXPECT_TRUE(allows({"10.1.2.3/22"}, "10.1.0.1"));
  EXPECT_TRUE(allows({"10.1.2.3/22"}, "10.1.3.255"));
  EXPECT_FALSE(allows({"10.1.2.3/22"}, "10.1.4.0"));
  EXPECT_TRUE(allows({"0.0.0.0/0"}, "203.0.113.9"));
  EXPECT_FALSE(allows({"0.0.0.0/0"}, "2001:db8::1"));
  EXPECT_TRUE(allows({"fd00::/8"}, "fd12::1"));
  EXPECT_FALSE(allows({"fd00::/8"}, "fe80::1"));
}

TEST(AllowList, RefusesWhatIsNoAddress) {
  for (const char* wrong : {"", "host.example", "10.0.0", "10.0.0.0/33", "10.0.0.0/", "10.0.0.0/-1",
                            "fd00::/129", "10.0.0.1 ", "/8"}) {
    const auto list = AllowList::parse({"10.0.0.1", wrong});
    ASSERT_FALSE(list) << wrong;
    EXPECT_EQ(list.error().context, wrong);
  }
}

TEST(AllowList, ObjectsWithTheKeyToChange) {
  const AllowList list = AllowList::parse({"10.0.0.20"}).value();
  EXPECT_EQ(list.objection(asio::ip::make_address("10.0.0.20"), "outputs.vrpn.allow"), "");
  EXPECT_THAT(list.objection(asio::ip::make_address("10.0.0.21"), "outputs.vrpn.allow"),
              HasSubstr("10.0.0.21 is not listed; add it to outputs.vrpn.allow"));
}

}  // namespace
}  // namespace chorus::net
