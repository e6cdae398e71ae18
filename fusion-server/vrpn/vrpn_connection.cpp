#include "fusion-server/vrpn/vrpn_connection.h"

#include <netinet/tcp.h>

#include <utility>

#include "common/base/shortened.h"

namespace chorus::vrpn {
namespace {

using net::error_code;

constexpr std::size_t kMostShown = 80;  // Characters of a name in status and log.

/// Room for one or two frames: the kernel should not buffer seconds of old poses.
constexpr int kSendBuffer = 128 * 1024;

/// An integer option that Asio does not define.
class TcpOption {
 public:
  TcpOption(int name, int value) : name_(name), value_(value) {}
  template <class Protocol>
  [[nodiscard]] int level(const Protocol& /*unused*/) const {
    return IPPROTO_TCP;
  }
  template <class Protocol>
  [[nodiscard]] int name(const Protocol& /*unused*/) const {
    return name_;
  }
  template <class Protocol>
  [[nodiscard]] const int* data(const Protocol& /*unused*/) const {
    return &value_;
  }
  template <class Protocol>
  [[nodiscard]] std::size_t size(const Protocol& /*unused*/) const {
    return sizeof value_;
  }

 private:
  int name_;
  int value_;
};

/// Sets the socket's options.  A client with datagrams is silent on TCP; keep-alive detects a dead
/// host after 25 s.
void set_options(net::Socket& socket) {
  error_code ignored;
  socket.set_option(net::tcp::no_delay(true), ignored);
  socket.set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
  socket.set_option(asio::socket_base::keep_alive(true), ignored);
  socket.set_option(TcpOption(TCP_KEEPIDLE, 10), ignored);
  socket.set_option(TcpOption(TCP_KEEPINTVL, 5), ignored);
  socket.set_option(TcpOption(TCP_KEEPCNT, 3), ignored);
}

}  // namespace

Connection::Connection(ConnectionContext context, net::Socket socket, Conversation conversation,
                       Closed closed)
    : context_(context),
      socket_(std::move(socket)),
      conversation_(std::move(conversation)),
      closed_(std::move(closed)),
      deadline_(std::chrono::steady_clock::now() + context.limits.handshake) {}

void Connection::start() {
  set_options(socket_);
  answers_ = Conversation::greeting();
  write();
  read();
}

void Connection::read() {
  if (reading_ || answers_.size() >= kMaxAnswers || !socket_.is_open()) return;
  reading_ = true;
  socket_.async_read_some(asio::buffer(input_),
                          [self = shared_from_this()](error_code failed, std::size_t size) {
                            self->reading_ = false;
                            self->on_read(failed, size);
                          });
}

void Connection::on_read(error_code failed, std::size_t size) {
  if (!socket_.is_open()) return;
  if (failed) return close();
  heard_ = std::chrono::steady_clock::now();
  auto answer = conversation_.receive({input_.data(), size}, context_.clock->now());
  if (!answer) return refuse(answer.error().message);
  if (const auto name = conversation_.take_unknown()) {
    ++context_.counters->refused;
    context_.turned_away->hit("a client asks for \"" + shortened(*name, kMostShown) +
                              "\", which is none of our trackers");
  }
  if (const auto port = conversation_.datagram_port()) {
    error_code gone;
    datagrams_to_ = {socket_.remote_endpoint(gone).address(), *port};
    if (gone) return close();
  }
  answers_ += *answer;
  write();
  read();
}

void Connection::write() {
  if (writing_ || !socket_.is_open()) return;
  output_ = std::exchange(answers_, {});
  if (const auto reports = std::exchange(waiting_, nullptr))
    output_ += conversation_.stream(*reports);
  if (output_.empty()) return;
  writing_ = true;
  if (conversation_.established()) {
    deadline_ = std::chrono::steady_clock::now() + context_.limits.stall;
  }
  asio::async_write(socket_, asio::buffer(output_),
                    [self = shared_from_this()](error_code failed, std::size_t) {
                      self->writing_ = false;
                      self->on_written(failed);
                    });
}

void Connection::on_written(error_code failed) {
  if (!socket_.is_open()) return;
  if (failed) return close();
  write();
  read();  // Reading may have stopped because too many answers were waiting.
}

void Connection::publish(const std::shared_ptr<const Reports>& reports) {
  if (!conversation_.established()) return;
  if (conversation_.datagram_port()) return send_datagrams(*reports);
  if (waiting_) ++context_.counters->dropped;
  waiting_ = reports;
  write();
}

void Connection::send_datagrams(const Reports& reports) {
  for (const std::string& datagram : conversation_.datagrams(reports)) {
    error_code failed;
    context_.datagrams->send_to(asio::buffer(datagram), datagrams_to_, 0, failed);
    if (failed) ++context_.counters->failed;
  }
}

void Connection::sweep(SteadyTime now) {
  if (now < deadline_) return;
  if (!conversation_.established())
    refuse("no cookie in time");
  else if (writing_)
    refuse("the client does not read");
}

void Connection::refuse(const std::string& reason) {
  ++context_.counters->refused;
  context_.turned_away->hit(reason);
  close();
}

void Connection::close() {
  if (!socket_.is_open()) return;
  const auto self = shared_from_this();  // closed_ releases the owner's reference.
  error_code ignored;
  socket_.close(ignored);
  closed_(this);
}

}  // namespace chorus::vrpn
