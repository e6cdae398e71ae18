// 300 long-polling clients in their own process, in one epoll loop, with no library between the
// socket and the time stamp.
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tests/bench/wire/http_load.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

std::int64_t steady_ns() { return std::chrono::steady_clock::now().time_since_epoch().count(); }

struct Client {
  int socket = -1;
  std::string received;
  std::uint64_t version = 0;
  bool asks = false;  ///< True if it has its answer and will send the next request.
};

std::uint64_t number_after(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(name);
  std::uint64_t value = 0;
  if (at != std::string_view::npos)
    std::from_chars(text.data() + at + name.size(), text.data() + text.size(), value);
  return value;
}

bool ask(Client& client) {
  std::string request = "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nPrefer: wait=10\r\n";
  if (client.version > 0)
    request += "If-None-Match: \"" + std::to_string(client.version) + "-ttl\"\r\n";
  request += "\r\n";
  return ::send(client.socket, request.data(), request.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(request.size());
}

bool connect(Client& client, std::uint16_t port) {
  client.socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = testing::loopback(port);
  const int on = 1;
  ::setsockopt(client.socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return ::connect(client.socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
}

/// The body of a complete answer; nothing while part of it is missing.
std::optional<std::string_view> complete_body(const std::string& received) {
  const std::size_t head = received.find("\r\n\r\n");
  if (head == std::string::npos) return {};
  const std::size_t length = number_after(received, "Content-Length: ");
  if (received.size() < head + 4 + length) return {};
  return std::string_view(received).substr(head + 4, length);
}

/// Reads what has arrived; false when the connection is lost.
bool on_readable(Client& client, bool measuring, LongPollAges& out) {
  std::array<char, 16384> bytes;
  const ssize_t size = ::recv(client.socket, bytes.data(), bytes.size(), 0);
  if (size <= 0) return false;
  client.received.append(bytes.data(), static_cast<std::size_t>(size));
  const auto body = complete_body(client.received);
  if (!body) return true;
  const std::int64_t now = steady_ns();
  const std::uint64_t version = number_after(client.received, "ETag: \"");
  ++out.answers;
  if (measuring && client.version > 0) {
    if (version != client.version + 1) ++out.repeated_or_missed;
    out.ages.push_back(
        1e-9 * static_cast<double>(now - static_cast<std::int64_t>(number_after(*body, "# "))));
  }
  client.version = version;
  client.received.clear();
  client.asks = true;
  return true;
}

Client& client_of(const epoll_event& event) { return *static_cast<Client*>(event.data.ptr); }

LongPollAges poll_all(const LongPollLoad& load) {
  LongPollAges out;
  std::vector<Client> clients(static_cast<std::size_t>(load.clients));
  const int queue = ::epoll_create1(0);
  for (Client& client : clients) {
    if (!connect(client, load.port) || !ask(client)) return {};
    epoll_event event{EPOLLIN, {.ptr = &client}};
    ::epoll_ctl(queue, EPOLL_CTL_ADD, client.socket, &event);
  }
  constexpr double kWarmUpSeconds = 1.0;
  const std::int64_t start = steady_ns();
  std::array<epoll_event, 512> events{};
  while (true) {
    const double elapsed = 1e-9 * static_cast<double>(steady_ns() - start);
    if (elapsed > kWarmUpSeconds + load.run_seconds) return out;
    const int count = ::epoll_wait(queue, events.data(), static_cast<int>(events.size()), 100);
    // Receive all answers first, then send the next requests: the clients of a real room do not
    // wait for one another.
    for (int i = 0; i < count; ++i) {
      if (!on_readable(client_of(events[static_cast<std::size_t>(i)]), elapsed > kWarmUpSeconds,
                       out))
        return {};
    }
    for (int i = 0; i < count; ++i) {
      Client& client = client_of(events[static_cast<std::size_t>(i)]);
      if (std::exchange(client.asks, false) && !ask(client)) return {};
    }
  }
}

void write_all(int to, const void* bytes, std::size_t size) {
  const auto* at = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t written = ::write(to, at, size);
    if (written <= 0) std::_Exit(1);
    at += written;
    size -= static_cast<std::size_t>(written);
  }
}

bool read_all(int from, void* bytes, std::size_t size) {
  auto* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = ::read(from, at, size);
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

Result<LongPollAges> run_long_polls(const LongPollLoad& load) {
  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) return fail(ErrorCode::Io, "pipe", "cannot make a pipe");
  const pid_t child = ::fork();
  if (child < 0) return fail(ErrorCode::Io, "fork", "cannot start a process");
  if (child == 0) {
    keep_to_side(Side::Load);
    const LongPollAges ages = poll_all(load);
    const std::array<std::uint64_t, 3> counts{ages.ages.size(), ages.answers,
                                              ages.repeated_or_missed};
    write_all(pipe[1], counts.data(), sizeof counts);
    write_all(pipe[1], ages.ages.data(), ages.ages.size() * sizeof(double));
    std::_Exit(0);
  }
  ::close(pipe[1]);
  LongPollAges ages;
  std::array<std::uint64_t, 3> counts{};
  bool complete = read_all(pipe[0], counts.data(), sizeof counts);
  ages.ages.resize(complete ? counts[0] : 0);
  complete = complete && read_all(pipe[0], ages.ages.data(), ages.ages.size() * sizeof(double));
  ages.answers = counts[1];
  ages.repeated_or_missed = counts[2];
  ::close(pipe[0]);
  ::waitpid(child, nullptr, 0);
  if (!complete || ages.ages.empty())
    return fail(ErrorCode::Unavailable, "long poll", "the clients lost their connections");
  return ages;
}

}  // namespace chorus::bench
