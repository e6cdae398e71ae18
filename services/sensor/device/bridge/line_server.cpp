#include "services/sensor/device/bridge/line_server.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <deque>
#include <filesystem>
#include <thread>
#include <unordered_set>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/log.h"
#include "common/net/asio_local.h"
#include "common/net/event_loop.h"
#include "common/net/every.h"

namespace chorus::bridge {
namespace {

using http::Reply;
using net::error_code;
using net::local_stream;
using net::LocalAcceptor;
using net::LocalSocket;

constexpr std::chrono::milliseconds kLook{250};
constexpr mode_t kMode = 0660;
constexpr std::size_t kMaxPath = 107;

std::string bye(const Error& error) {
  return nlohmann::json{{"type", "bye"},
                        {"code", name_of(error.code)},
                        {"context", error.context},
                        {"detail", error.message}}
      .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

/// The connection of one pusher.  Everything runs on the server's thread.
class LineConnection : public std::enable_shared_from_this<LineConnection> {
 public:
  LineConnection(LocalSocket socket, std::size_t max_line_bytes)
      : socket_(std::move(socket)), max_line_bytes_(max_line_bytes) {}

  void begin(Result<std::unique_ptr<http::Dialogue>> dialogue) {
    if (!dialogue) return react({{bye(dialogue.error())}, true});
    dialogue_ = std::move(*dialogue);
    read();
  }
  void look() {
    if (dialogue_) react(dialogue_->look());
  }
  void close() {
    dialogue_.reset();
    error_code ignored;
    socket_.close(ignored);
  }
  [[nodiscard]] bool is_open() const { return socket_.is_open(); }

 private:
  void read() {
    socket_.async_read_some(asio::buffer(chunk_),
                            [me = shared_from_this()](error_code failed, std::size_t size) {
                              me->on_read(failed, size);
                            });
  }
  void on_read(error_code failed, std::size_t size);
  void hear_lines();
  void react(Reply reply);
  void send_next();

  LocalSocket socket_;
  std::size_t max_line_bytes_;
  std::unique_ptr<http::Dialogue> dialogue_;
  std::array<char, 65536> chunk_{};
  std::string text_;
  std::deque<std::string> unsent_;  ///< The first one is being sent.
  std::size_t unsent_bytes_ = 0;
  bool over_ = false;  ///< True: the connection ends once unsent_ is empty.
};

void LineConnection::on_read(error_code failed, std::size_t size) {
  if (!is_open()) return;
  if (failed) return close();
  text_.append(chunk_.data(), size);
  hear_lines();
  if (is_open() && !over_) read();
}

void LineConnection::hear_lines() {
  std::size_t begin = 0;
  for (std::size_t end = text_.find('\n'); end != std::string::npos && dialogue_ && !over_;
       end = text_.find('\n', begin)) {
    const std::string_view line = std::string_view(text_).substr(begin, end - begin);
    begin = end + 1;
    if (!line.empty()) react(dialogue_->hear(line));
  }
  text_.erase(0, begin);
  if (text_.size() <= max_line_bytes_ || over_ || !dialogue_) return;
  react(dialogue_->end({ErrorCode::TooLarge,
                        {},
                        "a line has at most " + std::to_string(max_line_bytes_) + " bytes"}));
}

void LineConnection::react(Reply reply) {
  over_ = over_ || reply.over;
  const bool idle = unsent_.empty();
  for (std::string& message : reply.messages) {
    message += '\n';
    unsent_bytes_ += message.size();
    unsent_.push_back(std::move(message));
  }
  if (unsent_bytes_ > http::kMaxUnread) return close();
  if (idle) send_next();
}

void LineConnection::send_next() {
  if (unsent_.empty()) return over_ ? close() : void();
  asio::async_write(socket_, asio::buffer(unsent_.front()),
                    [me = shared_from_this()](error_code failed, std::size_t) {
                      if (failed) return me->close();
                      me->unsent_bytes_ -= me->unsent_.front().size();
                      me->unsent_.pop_front();
                      me->send_next();
                    });
}

/// True when a program accepts connections at the path.
bool answers(asio::io_context& io, const std::string& path) {
  LocalSocket probe(io.get_executor());
  error_code failed;
  probe.connect(local_stream::endpoint(path), failed);
  return !failed;
}

tl::unexpected<Error> cannot(const std::string& path, const std::string& why) {
  return fail(ErrorCode::Io, "device.bridge.socket", path + ": " + why);
}

/// Why there can be no socket at the path, and what to change.
tl::unexpected<Error> cannot_bind(const std::string& path, const error_code& failed) {
  const std::string folder = std::filesystem::absolute(path).parent_path().string();
  if (failed == boost::system::errc::no_such_file_or_directory) {
    return cannot(path, "there is no folder " + folder +
                            ": name a file in one that is there (systemd makes "
                            "/run/chorus-sensor while the unit of the package runs)");
  }
  if (failed == boost::system::errc::permission_denied)
    return cannot(path, "this user may make no file in " + folder + ": name one elsewhere");
  return cannot(path, failed.message());
}

}  // namespace

struct LineServer::Impl {
  explicit Impl(LineServerOptions o) : options(std::move(o)) {}

  [[nodiscard]] Result<void> open();
  void accept();
  void look();

  // The first member, so it is destroyed last, after everything that uses it.
  asio::io_context io{1};
  LineServerOptions options;
  LocalAcceptor acceptor{io.get_executor()};
  net::Every looking{io, kLook, [this] { look(); }};
  std::unordered_set<std::shared_ptr<LineConnection>> connections;
  bool accepting = false;
  bool bound = false;
  std::thread thread;
};

Result<void> LineServer::Impl::open() {
  const std::string& path = options.path;
  if (path.size() > kMaxPath) return cannot(path, "a path of a socket has at most 107 bytes");
  struct stat found {};
  if (::lstat(path.c_str(), &found) == 0) {
    if (!S_ISSOCK(found.st_mode)) return cannot(path, "there is a file that is no socket");
    if (answers(io, path)) return cannot(path, "another program listens there");
    ::unlink(path.c_str());
  }
  error_code failed;
  acceptor.open(local_stream(), failed);
  if (!failed) acceptor.bind(local_stream::endpoint(path), failed);
  if (failed) return cannot_bind(path, failed);
  bound = true;
  // Done before listen(), so that nobody can connect while the socket has another mode.
  if (::chmod(path.c_str(), kMode) != 0) return cannot(path, "its mode cannot be set");
  acceptor.listen(asio::socket_base::max_listen_connections, failed);
  if (failed) return cannot(path, failed.message());
  return {};
}

void LineServer::Impl::accept() {
  if (accepting || !acceptor.is_open()) return;
  accepting = true;
  acceptor.async_accept([this](error_code failed, LocalSocket socket) {
    accepting = false;
    if (failed) return;  // Perhaps all file descriptors are in use; look() tries again.
    auto connection = std::make_shared<LineConnection>(std::move(socket), options.max_line_bytes);
    connections.insert(connection);
    accept();
    connection->begin(options.open(""));
  });
}

void LineServer::Impl::look() {
  accept();
  std::erase_if(connections, [](const auto& connection) { return !connection->is_open(); });
  for (const auto& connection : connections) connection->look();
}

LineServer::LineServer() = default;

Result<std::unique_ptr<LineServer>> LineServer::start(LineServerOptions options) {
  std::unique_ptr<LineServer> server(new LineServer);
  server->impl_ = std::make_unique<Impl>(std::move(options));
  Impl& impl = *server->impl_;
  if (const auto ok = impl.open(); !ok) return pass(ok);
  impl.thread = std::thread([&impl] {
    net::run_events(impl.io, "a local socket failed", [&impl] {
      impl.accept();
      impl.looking.ensure();
    });
  });
  return server;
}

LineServer::~LineServer() {
  if (impl_->thread.joinable()) {
    asio::post(impl_->io, [impl = impl_.get()] {
      error_code ignored;
      impl->acceptor.close(ignored);
      impl->looking.stop();
      for (const auto& connection : impl->connections) connection->close();
      impl->connections.clear();
    });
    impl_->thread.join();
  }
  if (impl_->bound) ::unlink(impl_->options.path.c_str());
}

}  // namespace chorus::bridge
