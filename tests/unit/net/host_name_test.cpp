#include "common/net/host_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace chorus::net {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(HostName, AShortNameIsAskedByMulticastDnsToo) {
  EXPECT_THAT(names_of("sensor-1"), ElementsAre("sensor-1", "sensor-1.local"));
}

TEST(HostName, LocalIsNotAppendedToADomain) {
  EXPECT_THAT(names_of("s1.lab.example.org"), ElementsAre("s1.lab.example.org", "s1", "s1.local"));
  EXPECT_THAT(names_of("s1.local"), ElementsAre("s1.local", "s1"));
}

TEST(HostName, NoneHasNoNames) {
  EXPECT_THAT(names_of(""), IsEmpty());
  EXPECT_THAT(names_of(".local"), IsEmpty());
  EXPECT_FALSE(host_name().empty());
}

}  // namespace
}  // namespace chorus::net
