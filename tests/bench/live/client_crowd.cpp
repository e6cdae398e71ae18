// Hundreds of clients of one fusion server on one thread: VRPN, long polls, event streams,
// WebSockets.
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstring>
#include <limits>

#include "tests/bench/live/live_cell.h"
#include "tests/support/free_port.h"
#include "tests/support/vrpn/vrpn_client.h"

namespace chorus::bench {
namespace {

constexpr std::string_view kLongPoll =
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: application/json\r\nPrefer: wait=10\r\n\r\n";
constexpr std::string_view kEvents =
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n";
constexpr std::string_view kUpgrade =
    "GET /frame HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";

std::string_view after(std::string_view text, std::string_view name) {
  const std::size_t at = text.find(name);
  return at == std::string_view::npos ? std::string_view() : text.substr(at + name.size());
}

int connect_to(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = testing::loopback(port);
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
    return socket;
  ::close(socket);
  return -1;
}

/// Length of the WebSocket message at the beginning of `bytes` (RFC 6455, 5.2; a server does not
/// mask, and ours never splits a document); 0: its head is not complete yet.
std::size_t message_length(std::string_view bytes) {
  constexpr std::size_t kTwoBytes = 126;  // this value says that the length follows in two bytes
  constexpr std::size_t kEightBytes = 127;
  if (bytes.size() < 2) return 0;
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const std::size_t told = byte(1) & 0x7FU;
  const std::size_t more = told == kTwoBytes ? 2 : told == kEightBytes ? 8 : 0;
  if (bytes.size() < 2 + more) return 0;
  std::size_t length = more == 0 ? told : 0;
  for (std::size_t i = 0; i < more; ++i) length = length << 8U | byte(2 + i);
  return 2 + more + length;
}

enum class Reads { LongPolls, Events, WebSocket };

std::string_view first_request(Reads reads) {
  if (reads == Reads::Events) return kEvents;
  return reads == Reads::WebSocket ? kUpgrade : kLongPoll;
}

}  // namespace

struct ClientCrowd::Impl {
  struct Client {
    int socket = -1;
    std::unique_ptr<testing::VrpnClient> vrpn;
    Reads reads = Reads::LongPolls;
    bool open = false;  ///< The WebSocket's handshake is done.
    std::string received;
    std::atomic<std::uint64_t> frames = 0;
  };

  void watch(Client& client, int socket) const {
    epoll_event event{EPOLLIN, {.ptr = &client}};
    ::epoll_ctl(queue, EPOLL_CTL_ADD, socket, &event);
  }
  void add_reader(std::uint16_t port, Reads reads);
  void add_vrpn(std::uint16_t port);
  void run(const std::stop_token& stop);
  void on_readable(Client& client);
  void on_http(Client& client);
  void take_answer(Client& client);
  void take_events(Client& client);
  void take_messages(Client& client);

  int queue = ::epoll_create1(0);
  std::vector<std::unique_ptr<Client>> clients;
  std::atomic<std::uint64_t> vrpn_frames = 0, long_polls = 0, events = 0, messages = 0, lost = 0;
  std::jthread thread;
};

void ClientCrowd::Impl::add_reader(std::uint16_t port, Reads reads) {
  auto client = std::make_unique<Client>();
  client->socket = connect_to(port);
  client->reads = reads;
  const std::string_view request = first_request(reads);
  if (client->socket < 0 ||
      ::send(client->socket, request.data(), request.size(), MSG_NOSIGNAL) < 0)
    ++lost;
  watch(*client, client->socket);
  clients.push_back(std::move(client));
}

void ClientCrowd::Impl::add_vrpn(std::uint16_t port) {
  auto client = std::make_unique<Client>();
  client->vrpn = std::make_unique<testing::VrpnClient>(std::vector<std::string>{"Body0"});
  if (!client->vrpn->request(port)) ++lost;
  std::vector<pollfd> sockets;
  client->vrpn->add_sockets(sockets);
  for (const pollfd& socket : sockets) watch(*client, socket.fd);
  clients.push_back(std::move(client));
}

void ClientCrowd::Impl::run(const std::stop_token& stop) {
  std::array<epoll_event, 512> ready{};
  while (!stop.stop_requested()) {
    const int count = ::epoll_wait(queue, ready.data(), static_cast<int>(ready.size()), 50);
    for (int i = 0; i < count; ++i) {
      on_readable(*static_cast<Client*>(ready[static_cast<std::size_t>(i)].data.ptr));
    }
  }
}

void ClientCrowd::Impl::on_readable(Client& client) {
  if (!client.vrpn) return on_http(client);
  client.vrpn->read();
  for (const auto& message : client.vrpn->decoder.messages) {
    const auto pose = pose_of(message);
    if (!pose || pose->sensor != 0) continue;
    ++vrpn_frames;
    ++client.frames;
  }
  client.vrpn->decoder.messages.clear();
}

void ClientCrowd::Impl::on_http(Client& client) {
  std::array<char, 65536> bytes;
  const ssize_t got = ::recv(client.socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got <= 0) {
    if (got < 0 && errno == EAGAIN) return;
    ++lost;
    ::epoll_ctl(queue, EPOLL_CTL_DEL, client.socket, nullptr);
    return;
  }
  client.received.append(bytes.data(), static_cast<std::size_t>(got));
  switch (client.reads) {
    case Reads::LongPolls:
      return take_answer(client);
    case Reads::Events:
      return take_events(client);
    case Reads::WebSocket:
      return take_messages(client);
  }
}

/// An empty line ends an event.
void ClientCrowd::Impl::take_events(Client& client) {
  std::size_t end = 0;
  while ((end = client.received.find("\n\n")) != std::string::npos) {
    client.received.erase(0, end + 2);
    ++events;
    ++client.frames;
  }
}

void ClientCrowd::Impl::take_messages(Client& client) {
  if (!client.open) {
    const std::size_t head = client.received.find("\r\n\r\n");
    if (head == std::string::npos) return;
    client.open = true;
    client.received.erase(0, head + 4);
  }
  while (const std::size_t length = message_length(client.received)) {
    if (client.received.size() < length) return;
    client.received.erase(0, length);
    ++messages;
    ++client.frames;
  }
}

void ClientCrowd::Impl::take_answer(Client& client) {
  const std::size_t head = client.received.find("\r\n\r\n");
  if (head == std::string::npos) return;
  const std::string_view length = after(client.received, "Content-Length: ");
  std::size_t body = 0;
  std::from_chars(length.data(), length.data() + length.size(), body);
  if (client.received.size() < head + 4 + body) return;
  const std::string_view tag = after(client.received, "ETag: ");
  constexpr std::size_t kBlankLine = 2;
  std::string request(kLongPoll.substr(0, kLongPoll.size() - kBlankLine));
  request += "If-None-Match: " + std::string(tag.substr(0, tag.find('\r'))) + "\r\n\r\n";
  ++long_polls;
  ++client.frames;
  client.received.clear();
  (void)::send(client.socket, request.data(), request.size(), MSG_NOSIGNAL);
}

ClientCrowd::ClientCrowd(const LiveCell& cell, const ClientCounts& counts)
    : impl_(std::make_unique<Impl>()) {
  for (int i = 0; i < counts.vrpn; ++i) impl_->add_vrpn(cell.vrpn_port);
  const std::uint16_t port = counts.http_port != 0 ? counts.http_port : cell.port;
  for (int i = 0; i < counts.event_streams; ++i) impl_->add_reader(port, Reads::Events);
  for (int i = 0; i < counts.long_polls; ++i) impl_->add_reader(port, Reads::LongPolls);
  for (int i = 0; i < counts.websockets; ++i) impl_->add_reader(port, Reads::WebSocket);
  impl_->thread =
      std::jthread([impl = impl_.get()](const std::stop_token& stop) { impl->run(stop); });
}

ClientCrowd::~ClientCrowd() {
  impl_->thread.request_stop();
  impl_->thread.join();
  for (const auto& client : impl_->clients) {
    if (client->socket >= 0) ::close(client->socket);
  }
  ::close(impl_->queue);
}

ClientAnswers ClientCrowd::answers() const {
  ClientAnswers out{impl_->vrpn_frames, impl_->long_polls, impl_->events,
                    impl_->messages,    impl_->lost,       {}};
  for (const auto& client : impl_->clients) out.of_each.push_back(client->frames);
  return out;
}

std::uint64_t fewest(const ClientAnswers& before, const ClientAnswers& after) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  for (std::size_t i = 0; i < after.of_each.size(); ++i)
    least = std::min(least, after.of_each[i] - before.of_each[i]);
  return least;
}

}  // namespace chorus::bench
