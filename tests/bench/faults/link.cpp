#include "tests/bench/faults/link.h"

#include <algorithm>
#include <array>
#include <deque>
#include <list>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "common/base/duration.h"
#include "common/net/asio.h"
#include "common/net/prompt.h"

namespace chorus::bench {
namespace {

using asio::buffer;
using net::error_code;
using Instant = std::chrono::steady_clock::time_point;

constexpr std::size_t kMessageBytes = 16 * 1024;
constexpr std::size_t kMaxWaiting = 8u << 20;  // [bytes] under way per direction
constexpr auto kFrozenLook = std::chrono::milliseconds(20);

struct Switches {
  std::atomic<bool> frozen{false};
  std::atomic<std::int64_t> passes{-1};  ///< Bytes of answers that may still pass; -1: all.
};

struct Surroundings {
  const LinkModel* model = nullptr;
  Switches* switches = nullptr;
  std::mt19937* random = nullptr;
};

/// How long a message takes to arrive.
Duration time_under_way(const LinkModel& link, std::mt19937& random) {
  double out = link.delay;
  if (link.jitter > 0.0) out += std::uniform_real_distribution<>(0.0, link.jitter)(random);
  return from_seconds(out);
}

/// One direction of one connection: reads, holds back, writes.
class Direction {
 public:
  Direction(net::Socket& from, net::Socket& to, Surroundings around, bool answers)
      : from_(from), to_(to), around_(around), answers_(answers), timer_(from.get_executor()) {}

  void start(std::shared_ptr<void> keep) {
    keep_ = std::move(keep);
    read();
  }
  void stop() {
    timer_.cancel();
    keep_.reset();
  }

 private:
  struct Message {
    std::string bytes;
    Instant due;
  };

  void read();
  void take(std::size_t size);
  void write_next();
  void write_when_due();
  void write();
  void end();

  net::Socket& from_;
  net::Socket& to_;
  Surroundings around_;
  bool answers_;
  net::Timer timer_;
  std::shared_ptr<void> keep_;
  std::array<char, kMessageBytes> bytes_{};
  std::deque<Message> waiting_;
  std::size_t waiting_bytes_ = 0;
  bool reading_ = false;
  bool writing_ = false;
  bool over_ = false;  ///< One end has hung up; the other is closed after the last message.
};

void Direction::read() {
  if (reading_ || over_ || waiting_bytes_ > kMaxWaiting) return;
  reading_ = true;
  from_.async_read_some(buffer(bytes_),
                        [this, keep = keep_](const error_code& failed, std::size_t size) {
                          reading_ = false;
                          if (failed) {
                            over_ = true;
                            if (!writing_) end();
                            return;
                          }
                          take(size);
                          read();
                        });
}

void Direction::take(std::size_t size) {
  Instant due = std::chrono::steady_clock::now() + time_under_way(*around_.model, *around_.random);
  if (!waiting_.empty()) due = std::max(due, waiting_.back().due);
  waiting_.push_back({std::string(bytes_.data(), size), due});
  waiting_bytes_ += size;
  if (!writing_) write_next();
}

void Direction::write_next() {
  writing_ = !waiting_.empty();
  if (writing_) return write_when_due();
  if (over_) return end();
  read();
}

void Direction::write_when_due() {
  const bool held =
      around_.switches->frozen || (answers_ && around_.switches->passes == std::int64_t{0});
  timer_.expires_at(held ? std::chrono::steady_clock::now() + kFrozenLook : waiting_.front().due);
  timer_.async_wait([this, held, keep = keep_](const error_code& failed) {
    if (failed) return;
    if (held) return write_when_due();
    write();
  });
}

void Direction::write() {
  std::string& bytes = waiting_.front().bytes;
  std::size_t size = bytes.size();
  auto& passes = around_.switches->passes;
  if (const std::int64_t left = passes; answers_ && left >= 0) {
    size = std::min(size, static_cast<std::size_t>(left));
    passes = left - static_cast<std::int64_t>(size);
  }
  asio::async_write(to_, buffer(bytes.data(), size),
                    [this, keep = keep_](const error_code& failed, std::size_t written) {
                      if (failed) return end();
                      waiting_bytes_ -= written;
                      Message& first = waiting_.front();
                      if (written < first.bytes.size()) {
                        first.bytes.erase(0, written);
                      } else {
                        waiting_.pop_front();
                      }
                      write_next();
                    });
}

void Direction::end() {
  error_code ignored;
  over_ = true;
  to_.shutdown(net::tcp::socket::shutdown_send, ignored);
  from_.shutdown(net::tcp::socket::shutdown_receive, ignored);
  stop();
}

struct Connection : std::enable_shared_from_this<Connection> {
  Connection(net::Socket accepted, net::Socket onward, Surroundings around)
      : client(std::move(accepted)),
        server(std::move(onward)),
        requests(client, server, around, false),
        answers(server, client, around, true) {}

  void cut() {
    error_code ignored;
    requests.stop();
    answers.stop();
    client.close(ignored);
    server.close(ignored);
  }

  net::Socket client;
  net::Socket server;
  Direction requests;
  Direction answers;
};

}  // namespace

PumpEnds on_loopback(std::uint16_t target) {
  const auto loopback = asio::ip::address_v4::loopback();
  return {[loopback](asio::io_context& io) {
            return net::Acceptor(io, {loopback, 0});
          },
          [](asio::io_context& io) { return net::Socket(io); },
          {loopback, target}};
}

struct Pump::Impl {
  Impl(PumpEnds both, const LinkModel& first, std::uint32_t seed)
      : model(first),
        random(seed),
        around{&model, &switches, &random},
        ends(std::move(both)),
        acceptor(ends.listen(io)) {}

  void accept() {
    acceptor.async_accept([this](const error_code& failed, net::Socket socket) {
      if (failed) return;
      auto connection = std::make_shared<Connection>(std::move(socket), ends.socket(io), around);
      connections.push_back(connection);
      connection->server.async_connect(ends.target, [connection](const error_code& refused) {
        if (refused) return connection->cut();
        // Services call make_prompt() for their connections; the pump, which is in between, must do
        // so for its own.
        for (net::Socket* each : {&connection->client, &connection->server})
          net::make_prompt(*each);
        connection->requests.start(connection);
        connection->answers.start(connection);
      });
      std::erase_if(connections, [](const auto& each) { return each.expired(); });
      accept();
    });
  }

  void stop() {
    error_code ignored;
    acceptor.close(ignored);
    for (const auto& each : connections) {
      if (const auto connection = each.lock()) connection->cut();
    }
    io.stop();
  }

  asio::io_context io{1};
  LinkModel model;  ///< Changed on the io_context's thread.
  Switches switches;
  std::mt19937 random;
  Surroundings around;
  PumpEnds ends;
  net::Acceptor acceptor;
  std::list<std::weak_ptr<Connection>> connections;
  std::jthread thread;
};

Pump::Pump(PumpEnds ends, const LinkModel& model, std::uint32_t seed)
    : impl_(std::make_unique<Impl>(std::move(ends), model, seed)) {
  impl_->accept();
  impl_->thread = std::jthread([impl = impl_.get()] { impl->io.run(); });
}

Pump::~Pump() {
  asio::post(impl_->io, [impl = impl_.get()] { impl->stop(); });
}

std::uint16_t Pump::port() const { return impl_->acceptor.local_endpoint().port(); }

void Pump::become(const LinkModel& model) {
  asio::post(impl_->io, [impl = impl_.get(), model] { impl->model = model; });
}

void Pump::freeze(bool frozen) {
  impl_->switches.frozen = frozen;
  if (!frozen) impl_->switches.passes = -1;
}

void Pump::freeze_after(std::size_t bytes) {
  impl_->switches.passes = static_cast<std::int64_t>(bytes);
}

}  // namespace chorus::bench
