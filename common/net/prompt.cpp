#include "common/net/prompt.h"

#include <netinet/in.h>
#include <netinet/tcp.h>

namespace chorus::net {
namespace {

#ifdef TCP_RTO_MIN_US
constexpr int kMinTimeout = TCP_RTO_MIN_US;
#else
constexpr int kMinTimeout = 45;  // From linux/tcp.h; the headers of this system are older.
#endif

/// Receivers delay acknowledgements by up to 40 ms; with a shorter time, each delayed one would
/// count as a loss.
constexpr int kRepeatAfterUs = 60'000;

}  // namespace

void make_prompt(Socket& socket) {
  using NoDelay = asio::detail::socket_option::boolean<IPPROTO_TCP, TCP_NODELAY>;
  using Linear = asio::detail::socket_option::boolean<IPPROTO_TCP, TCP_THIN_LINEAR_TIMEOUTS>;
  using MinTimeout = asio::detail::socket_option::integer<IPPROTO_TCP, kMinTimeout>;
  error_code ignored;
  socket.set_option(NoDelay(true), ignored);
  socket.set_option(Linear(true), ignored);
  socket.set_option(MinTimeout(kRepeatAfterUs), ignored);
}

}  // namespace chorus::net
