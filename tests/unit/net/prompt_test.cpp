// What is set on connections whose small messages have to arrive soon.
#include "common/net/prompt.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <gtest/gtest.h>

namespace chorus::net {
namespace {

int option(Socket& socket, int name) {
  int value = -1;
  socklen_t size = sizeof(value);
  return ::getsockopt(socket.native_handle(), IPPROTO_TCP, name, &value, &size) == 0 ? value : -1;
}

TEST(Prompt, SendsAtOnceAndRepeatsSoon) {
  constexpr int kMinTimeout = 45;  // TCP_RTO_MIN_US
  asio::io_context io;
  Socket socket(io, tcp::v4());
  const bool known = option(socket, kMinTimeout) != -1;
  make_prompt(socket);
  EXPECT_NE(option(socket, TCP_NODELAY), 0);
  EXPECT_NE(option(socket, TCP_THIN_LINEAR_TIMEOUTS), 0);
  if (known) {
    EXPECT_EQ(option(socket, kMinTimeout), 60'000);
  }
}

TEST(Prompt, AClosedSocketIsLeftAlone) {
  asio::io_context io;
  Socket socket(io);
  make_prompt(socket);
  EXPECT_FALSE(socket.is_open());
}

}  // namespace
}  // namespace chorus::net
