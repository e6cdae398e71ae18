#include "common/service/supervisor.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>

#include "common/base/parse.h"

namespace chorus::service {
namespace {

/// False for a watchdog that is meant for another process, such as a wrapper.
bool is_ours(const std::string& pid) { return pid.empty() || pid == std::to_string(::getpid()); }

}  // namespace

Supervisor::Supervisor(const Environment& environment)
    : socket_(value_of(environment, "NOTIFY_SOCKET")) {
  const std::string allowed = value_of(environment, "WATCHDOG_USEC");
  const auto number = parse_number<std::int64_t>(allowed);
  if (number && *number > 1 && is_ours(value_of(environment, "WATCHDOG_PID")))
    pulse_ = std::chrono::microseconds(*number / 2);
}

bool Supervisor::tell(std::string_view message) const {
  sockaddr_un address{};
  const bool usable = !socket_.empty() && (socket_[0] == '/' || socket_[0] == '@') &&
                      socket_.size() < sizeof(address.sun_path);
  if (!usable) return false;
  address.sun_family = AF_UNIX;
  std::copy(socket_.begin(), socket_.end(), address.sun_path);
  if (address.sun_path[0] == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  const int file = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (file < 0) return false;
  const ssize_t sent = ::sendto(file, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                                reinterpret_cast<const sockaddr*>(&address), size);
  ::close(file);
  return sent == static_cast<ssize_t>(message.size());
}

}  // namespace chorus::service
