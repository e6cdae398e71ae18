// Feeds arbitrary bytes, as a sensor's answer, to the client that polls it: the result is a
// response or an Error, then a frame or a reason.  The same bytes are also read as an event stream.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/client/answer.h"
#include "common/client/frames.h"
#include "common/http/client.h"
#include "common/http/event_reader.h"
#include "common/net/asio.h"

namespace {

using namespace chorus;
using asio::ip::address_v4;

void require(bool holds) {
  if (!holds) std::abort();
}

/// Answers the first request with these bytes and closes the connection.
class Sensor {
 public:
  Sensor(asio::io_context& io, std::string_view answer)
      : acceptor_(io), socket_(io), answer_(answer) {
    const net::tcp::endpoint any(address_v4::loopback(), 0);
    acceptor_.open(any.protocol());
    acceptor_.set_option(asio::socket_base::reuse_address(true));
    acceptor_.bind(any);
    acceptor_.listen();
    acceptor_.async_accept(socket_, [this](net::error_code failed) {
      if (!failed) hear();
    });
  }
  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  void close() {
    net::error_code ignored;
    acceptor_.close(ignored);
    socket_.close(ignored);
  }

 private:
  void hear() {
    socket_.async_read_some(asio::buffer(asked_), [this](net::error_code failed, std::size_t) {
      if (failed) return close();
      asio::async_write(socket_, asio::buffer(answer_),
                        [this](net::error_code, std::size_t) { close(); });
    });
  }

  net::Acceptor acceptor_;
  net::Socket socket_;
  std::string_view answer_;
  std::array<char, 4096> asked_{};
};

std::optional<http::ClientResponse> ask(std::string_view answer) {
  asio::io_context io{1};
  Sensor sensor(io, answer);
  http::AsyncClient client(io, "127.0.0.1", sensor.port(), {.max_body_bytes = 2u << 20});
  std::optional<http::ClientResponse> out;
  client.send({"GET", "/frame", {}, {}}, std::chrono::seconds(2),
              [&](Result<http::ClientResponse> got) {
                if (got) {
                  out = std::move(*got);
                } else {
                  require(!got.error().message.empty());
                }
                client.close();
                sensor.close();
              });
  io.run();
  return out;
}

void check_answer(std::string_view bytes) {
  const auto response = ask(bytes);
  if (!response) return;
  const SensorId sensor = SensorId::parse("s1").value();
  const auto answer = client::read_answer(*response, client::kFrames, sensor);
  if (answer.document.value) {
    const auto frame = client::place_in_time(
        {sensor,
         std::static_pointer_cast<const resource::FrameResource>(answer.document.value),
         Timestamp{},
         {},
         {}});
    require(frame.bodies.size() <= kMaxBodies);
  }
  (void)client::read_floor_answer(*response);
  (void)client::exchange_of(*response);
}

/// However the stream is split, it gives the same events.
void check_events(std::string_view bytes) {
  constexpr std::size_t kMax = 2u << 20;
  http::EventReader whole(kMax);
  http::EventReader parts(kMax);
  const auto at_once = whole.take(bytes);
  std::vector<http::ServerEvent> one_by_one;
  for (const char& each : bytes) {
    auto events = parts.take({&each, 1});
    if (!events) return require(!at_once.has_value());
    one_by_one.insert(one_by_one.end(), events->begin(), events->end());
  }
  require(at_once.has_value() && *at_once == one_by_one);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  check_answer(text);
  check_events(text);
  return 0;
}
