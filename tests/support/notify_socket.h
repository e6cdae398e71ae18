// The receiving end of sd_notify.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

namespace chorus::testing {

class NotifySocket {
 public:
  /// `name`: a path, or a name in the abstract namespace after "@".
  explicit NotifySocket(const std::string& name) : file_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::copy(name.begin(), name.end(), address.sun_path);
    if (name[0] == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    if (::bind(file_, reinterpret_cast<const sockaddr*>(&address), size) != 0)
      throw std::runtime_error("cannot bind " + name);
  }
  ~NotifySocket() { ::close(file_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// The messages received since the last call.
  [[nodiscard]] std::vector<std::string> received() const {
    std::vector<std::string> all;
    std::array<char, 256> text{};
    ssize_t size = 0;
    while ((size = ::recv(file_, text.data(), text.size(), MSG_DONTWAIT)) >= 0)
      all.emplace_back(text.data(), static_cast<std::size_t>(size));
    return all;
  }

 private:
  int file_;
};

}  // namespace chorus::testing
