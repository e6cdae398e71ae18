#include "tests/bench/faults/sockets.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

namespace chorus::bench {
namespace {

constexpr double kMilli = 1e3;

bool readable(int descriptor, double patience) {
  pollfd waiting{descriptor, POLLIN, 0};
  return ::poll(&waiting, 1, static_cast<int>(kMilli * patience)) > 0;
}

RawSocket socket_to(const End& end, int kind, bool small_buffer) {
  const int descriptor = ::socket(AF_INET, kind | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(end.port);
  ::inet_pton(AF_INET, end.host.c_str(), &address.sin_addr);
  constexpr int kSmall = 4096;
  if (small_buffer) ::setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &kSmall, sizeof kSmall);
  RawSocket socket(descriptor);
  if (::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return socket;
  return RawSocket(-1);
}

}  // namespace

RawSocket::RawSocket(RawSocket&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

RawSocket::~RawSocket() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool RawSocket::say(std::string_view bytes) const {
  return ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
         static_cast<ssize_t>(bytes.size());
}

std::string RawSocket::hear(double patience) const {
  constexpr std::size_t kMax = 65536;
  if (!readable(descriptor_, patience)) return {};
  std::string bytes(kMax, '\0');
  const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

std::string RawSocket::hear_all(double silence) const {
  std::string all;
  for (std::string part = hear(silence); !part.empty(); part = hear(silence)) all += part;
  return all;
}

bool RawSocket::hung_up() const {
  std::array<char, 4096> last_words{};
  ssize_t got = 0;
  do {
    got = ::recv(descriptor_, last_words.data(), last_words.size(), MSG_DONTWAIT);
  } while (got > 0);
  return got == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
}

RawSocket connect_to(const End& end, bool small_buffer) {
  return socket_to(end, SOCK_STREAM, small_buffer);
}

RawSocket datagrams_to(const End& end) { return socket_to(end, SOCK_DGRAM, false); }

std::string head_of_answer(const End& end, std::string_view request) {
  constexpr double kAnswerPatience = 3.0;
  const RawSocket socket = connect_to(end);
  std::string answer;
  if (!socket.open() || !socket.say(request)) return answer;
  while (answer.find("\r\n\r\n") == std::string::npos) {
    const std::string part = socket.hear(kAnswerPatience);
    if (part.empty()) break;
    answer += part;
  }
  return answer.substr(0, answer.find("\r\n\r\n"));
}

int status_of(std::string_view answer) {
  constexpr std::string_view kBefore = "HTTP/1.1 ";
  if (!answer.starts_with(kBefore)) return 0;
  return std::atoi(std::string(answer.substr(kBefore.size(), 3)).c_str());
}

std::optional<std::string> foreign_address() {
  ifaddrs* all = nullptr;
  if (::getifaddrs(&all) != 0) return std::nullopt;
  std::optional<std::string> found;
  for (const ifaddrs* each = all; each != nullptr && !found; each = each->ifa_next) {
    const bool up = (each->ifa_flags & IFF_UP) != 0 && (each->ifa_flags & IFF_LOOPBACK) == 0;
    if (!up || each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    std::array<char, INET_ADDRSTRLEN> text{};
    const auto* address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    ::inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    found = text.data();
  }
  ::freeifaddrs(all);
  return found;
}

}  // namespace chorus::bench
