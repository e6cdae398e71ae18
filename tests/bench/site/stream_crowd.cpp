// Thousands of readers of an event stream in one process: what each gets, and how late.
// Usage: chorus-stream-crowd PORT PATH READERS SECONDS; prints one line of JSON.
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>

#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Reader {
  int socket = -1;
  std::string line;  ///< The beginning of a line whose end has not come.
  std::string id;    ///< Of the event that is being read.
  std::uint64_t events = 0;
};

/// Of one event: when the first reader had it, and how much later than the first the others did.
class Lateness {
 public:
  void arrived(const std::string& id, double at) {
    const auto [first, is_new] = first_.try_emplace(id, at);
    if (!is_new) after_first_.push_back(static_cast<float>(at - first->second));
  }
  [[nodiscard]] double quantile(double share) {
    if (after_first_.empty()) return 0.0;
    const auto rank =
        static_cast<std::ptrdiff_t>(share * static_cast<double>(after_first_.size() - 1));
    std::ranges::nth_element(after_first_, after_first_.begin() + rank);
    return after_first_[static_cast<std::size_t>(rank)];
  }
  [[nodiscard]] std::size_t events() const { return first_.size(); }
  void clear() {
    first_.clear();
    after_first_.clear();
  }

 private:
  std::unordered_map<std::string, double> first_;
  std::vector<float> after_first_;
};

bool connect(Reader& reader, std::uint16_t port, const std::string& request) {
  reader.socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = testing::loopback(port);
  const int on = 1;
  ::setsockopt(reader.socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  return ::connect(reader.socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) ==
             0 &&
         ::send(reader.socket, request.data(), request.size(), MSG_NOSIGNAL) ==
             static_cast<ssize_t>(request.size());
}

/// An event ends with an empty line; its data, of thousands of bytes, is passed over.
void read_lines(Reader& reader, std::string_view bytes, Lateness& lateness, double at) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view piece = bytes.substr(0, end);
    if (reader.line.size() < 64) reader.line.append(piece.substr(0, 64));
    if (end == std::string_view::npos) return;
    bytes.remove_prefix(end + 1);
    if (reader.line.starts_with("id:")) reader.id = reader.line.substr(3);
    if (reader.line.empty() && !reader.id.empty()) {
      ++reader.events;
      lateness.arrived(reader.id, at);
      reader.id.clear();
    }
    reader.line.clear();
  }
}

struct Crowd {
  std::vector<Reader> readers;
  int queue = -1;
  std::size_t lost = 0;
  std::uint64_t bytes = 0;
  Lateness lateness;
};

bool join(Crowd& crowd, std::uint16_t port, const std::string& path) {
  const std::string request =
      "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n";
  crowd.queue = ::epoll_create1(0);
  for (Reader& reader : crowd.readers) {
    if (!connect(reader, port, request)) return false;
    epoll_event event{EPOLLIN, {.ptr = &reader}};
    ::epoll_ctl(crowd.queue, EPOLL_CTL_ADD, reader.socket, &event);
  }
  return true;
}

void read_for(Crowd& crowd, double seconds) {
  static std::array<char, 1 << 16> bytes;
  std::array<epoll_event, 1024> events{};
  const double end = now_s() + seconds;
  while (now_s() < end) {
    const int count = ::epoll_wait(crowd.queue, events.data(), static_cast<int>(events.size()), 50);
    for (int i = 0; i < count; ++i) {
      Reader& reader = *static_cast<Reader*>(events[static_cast<std::size_t>(i)].data.ptr);
      const ssize_t size = ::recv(reader.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
      if (size > 0) {
        crowd.bytes += static_cast<std::uint64_t>(size);
        read_lines(reader, {bytes.data(), static_cast<std::size_t>(size)}, crowd.lateness, now_s());
      } else if (size == 0) {
        ++crowd.lost;
        ::epoll_ctl(crowd.queue, EPOLL_CTL_DEL, reader.socket, nullptr);
      }
    }
  }
}

template <class Number>
bool read_number(const char* text, Number& into) {
  const std::string_view all(text);
  return std::from_chars(all.data(), all.data() + all.size(), into).ec == std::errc{};
}

int run(std::uint16_t port, const std::string& path, std::size_t count, double seconds) {
  Crowd crowd;
  crowd.readers.resize(count);
  if (!join(crowd, port, path)) {
    fmt::print(stderr, "not every reader could connect\n");
    return 1;
  }
  read_for(crowd, 3.0);  // The first documents come at once, to all.
  for (Reader& reader : crowd.readers) reader.events = 0;
  crowd.lateness.clear();
  crowd.bytes = 0;
  fmt::print("begin\n");
  std::fflush(stdout);
  read_for(crowd, seconds);
  std::uint64_t all = 0;
  std::uint64_t fewest = crowd.readers.front().events;
  for (const Reader& reader : crowd.readers) {
    all += reader.events;
    fewest = std::min(fewest, reader.events);
  }
  fmt::print(
      "{{\"deliveries\": {}, \"bytes\": {}, \"fewest\": {}, \"events\": {}, \"lost\": {}, "
      "\"late_p50_ms\": {:.2f}, \"late_p99_ms\": {:.2f}}}\n",
      all, crowd.bytes, fewest, crowd.lateness.events(), crowd.lost,
      1e3 * crowd.lateness.quantile(0.5), 1e3 * crowd.lateness.quantile(0.99));
  return 0;
}

}  // namespace
}  // namespace chorus::bench

int main(int count, char** words) {
  std::uint16_t port = 0;
  std::size_t readers = 0;
  double seconds = 0.0;
  using namespace chorus::bench;
  if (count != 5 || !read_number(words[1], port) || !read_number(words[3], readers) ||
      !read_number(words[4], seconds) || readers == 0) {
    fmt::print(stderr, "usage: chorus-stream-crowd PORT PATH READERS SECONDS\n");
    return 2;
  }
  return run(port, words[2], readers, seconds);
}
