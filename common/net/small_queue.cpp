#include "common/net/small_queue.h"

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

namespace chorus::net {
namespace {

constexpr int kUnsentBytes = 4096;

}  // namespace

void keep_queue_small(Socket& socket) {
  constexpr int kSendBufferBytes = 64 * 1024;
  const int file = socket.native_handle();
  ::setsockopt(file, SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes, sizeof kSendBufferBytes);
  ::setsockopt(file, IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kUnsentBytes, sizeof kUnsentBytes);
}

bool is_queue_small(Socket& socket) {
  int unsent = 0;
  return ::ioctl(socket.native_handle(), SIOCOUTQNSD, &unsent) != 0 || unsent <= kUnsentBytes;
}

}  // namespace chorus::net
