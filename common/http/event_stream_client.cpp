#include "common/http/event_stream_client.h"

#include <limits>
#include <optional>
#include <utility>

#include "common/http/beast.h"
#include "common/http/client_wire.h"
#include "common/http/media_range.h"
#include "common/http/status.h"
#include "common/net/connect.h"
#include "common/net/stream.h"
#include "common/time/clock.h"

namespace chorus::http {
namespace {

namespace beast = boost::beast;
using Parser = beast::http::response_parser<beast::http::string_body>;

constexpr std::size_t kReadBytes = 65536;

bool is_event_stream(const ClientResponse& head) {
  const auto type = head.headers.find("content-type");
  return head.status == status::kOk && type != head.headers.end() &&
         without_parameters(type->second) == "text/event-stream";
}

}  // namespace

struct AsyncEventStream::Impl : std::enable_shared_from_this<AsyncEventStream::Impl> {
  Impl(asio::io_context& io, const Url& to, ClientLimits with, tls::Trust believing)
      : host(to.host),
        port(to.port),
        secure(to.secure),
        trust(std::move(believing)),
        limits(with),
        authority(authority_of(host, port)),
        resolver(io.get_executor()),
        stream(io.get_executor()),
        timer(io.get_executor()),
        rest(io.get_executor()) {}

  void begin(const ClientRequest& request, Handlers with);
  void seal();
  void write();
  void read_head();
  void on_head(net::error_code failed);
  void read();
  void read_now();
  [[nodiscard]] net::error_code parse();
  void on_read(net::error_code failed);
  void arm(std::chrono::milliseconds time, std::string_view doing);
  void end(Error error);
  void drop();
  [[nodiscard]] bool has_head() const { return parser && parser->is_header_done(); }
  /// False for a handler that belongs to an earlier stream.
  [[nodiscard]] bool is(std::uint64_t mine) const { return attempt == mine; }

  const std::string host;
  const std::uint16_t port;
  const bool secure;
  const tls::Trust trust;
  const ClientLimits limits;
  const std::string authority;
  net::Resolver resolver;
  net::Stream stream;
  net::Timer timer;
  net::Timer rest;
  /// Shared, because a handler may close() the stream while it is running.
  std::shared_ptr<const Handlers> handlers;
  std::uint64_t attempt = 0;
  std::string out;
  beast::flat_buffer in;
  std::optional<Parser> parser;
  std::optional<EventReader> reader;
  std::int64_t sent_ns = 0;
  std::chrono::milliseconds paused{0};
};

void AsyncEventStream::Impl::begin(const ClientRequest& request, Handlers with) {
  drop();
  handlers = std::make_shared<const Handlers>(std::move(with));
  out = request_text(request, authority);
  reader.emplace(limits.max_body_bytes);
  arm(limits.connect_timeout, "connect");
  const auto self = shared_from_this();
  net::Connecting to{host, port, [self, mine = attempt] { return self->is(mine); }};
  net::connect_to(std::move(to), resolver, stream.socket(),
                  [self](net::error_code failed, std::string_view doing) {
                    if (!failed) return self->secure ? self->seal() : self->write();
                    self->end({ErrorCode::Unavailable, self->authority,
                               "cannot " + std::string(doing) + ": " + failed.message()});
                  });
}

void AsyncEventStream::Impl::seal() {
  arm(limits.connect_timeout, "TLS handshake");
  stream.seal_as_client(
      trust, host,
      [self = shared_from_this(), mine = attempt](const net::Stream::Sealing& sealing) {
        if (!self->is(mine)) return;
        if (!sealing.failure) return self->write();
        self->end({sealing.failure->code, self->authority, sealing.failure->message});
      });
}

void AsyncEventStream::Impl::write() {
  arm(limits.answer_timeout, "answer");
  sent_ns = to_unix_ns(SystemClock().now());
  asio::async_write(
      stream, asio::buffer(out),
      [self = shared_from_this(), mine = attempt](net::error_code failed, std::size_t) {
        if (!self->is(mine)) return;
        failed ? self->end(
                     {ErrorCode::Unavailable, self->authority, "cannot send: " + failed.message()})
               : self->read_head();
      });
}

void AsyncEventStream::Impl::read_head() {
  parser.emplace();
  parser->header_limit(kMaxAnswerHeadBytes);
  // A stream lasts until one side hangs up.
  parser->body_limit(std::numeric_limits<std::uint64_t>::max());
  in.reserve(kMaxAnswerHeadBytes);
  beast::http::async_read_header(
      stream, in, *parser,
      [self = shared_from_this(), mine = attempt](net::error_code failed, std::size_t) {
        if (self->is(mine)) self->on_head(failed);
      });
}

void AsyncEventStream::Impl::on_head(net::error_code failed) {
  if (failed)
    return end({ErrorCode::Unavailable, authority,
                "the answer is broken or cut off: " + failed.message()});
  if (parser->get().result_int() < unsigned{status::kOk})
    return read_head();  // An interim answer, such as 100 Continue.
  timer.cancel();
  ClientResponse head = response_of(parser->get().base());
  head.sent_ns = sent_ns;
  head.received_ns = to_unix_ns(SystemClock().now());
  const bool streams = is_event_stream(head);
  const auto mine = attempt;
  const auto told = handlers;
  told->on_head(head);
  if (!is(mine)) return;
  if (streams) return on_read({});  // The first events may have come with the head.
  end({ErrorCode::Unsupported, authority, "answers no event stream"});
}

void AsyncEventStream::Impl::read() {
  if (paused.count() == 0) return read_now();
  rest.expires_after(std::exchange(paused, std::chrono::milliseconds{0}));
  rest.async_wait([self = shared_from_this(), mine = attempt](net::error_code cancelled) {
    if (!cancelled && self->is(mine)) self->read_now();
  });
}

/// Does not use Beast's async_read_some, which goes on reading, and collecting, as long as what has
/// come ends within the head of a chunk.
void AsyncEventStream::Impl::read_now() {
  stream.async_read_some(in.prepare(kReadBytes), [self = shared_from_this(), mine = attempt](
                                                     net::error_code failed, std::size_t size) {
    if (!self->is(mine)) return;
    self->in.commit(size);
    self->on_read(failed);
  });
}

/// Parses all bytes that have come, except an unfinished head of a chunk, whose size it limits.
net::error_code AsyncEventStream::Impl::parse() {
  net::error_code broken;
  parser->eager(true);
  if (in.size() > 0) in.consume(parser->put(in.data(), broken));
  if (broken == beast::http::error::need_more) broken = {};
  if (!broken && in.size() > kMaxAnswerHeadBytes) broken = beast::http::error::buffer_overflow;
  return broken;
}

void AsyncEventStream::Impl::on_read(net::error_code failed) {
  net::error_code broken = parse();
  if (!broken && failed == asio::error::eof) parser->put_eof(broken);
  if (!broken && failed != asio::error::eof) broken = failed;
  std::string& bytes = parser->get().body();
  auto events = reader->take(bytes);
  bytes.clear();  // Keeps its memory for what comes next.
  const auto mine = attempt;
  const auto told = handlers;
  if (events && !events->empty()) told->on_events(std::move(*events));
  if (!is(mine)) return;
  if (!events) return end(events.error());
  if (broken) {
    return end({ErrorCode::Unavailable, authority, "the stream broke off: " + broken.message()});
  }
  if (parser->is_done()) return end({ErrorCode::Unavailable, authority, "the stream ended"});
  read();
}

void AsyncEventStream::Impl::arm(std::chrono::milliseconds time, std::string_view doing) {
  timer.expires_after(time);
  timer.async_wait(
      [self = shared_from_this(), mine = attempt, doing, time](net::error_code cancelled) {
        // The timer may have been cancelled or set again after it expired but before this handler
        // ran.
        if (cancelled || !self->is(mine) || self->has_head()) return;
        if (self->timer.expiry() > std::chrono::steady_clock::now()) return;
        self->end({ErrorCode::Timeout, self->authority,
                   "no " + std::string(doing) + " within " + std::to_string(time.count()) + " ms"});
      });
}

void AsyncEventStream::Impl::end(Error error) {
  drop();
  // The handler may call open() again, close() or destroy this client.
  if (const auto over = std::exchange(handlers, nullptr)) over->on_end(std::move(error));
}

void AsyncEventStream::Impl::drop() {
  ++attempt;
  resolver.cancel();
  stream.close();
  timer.cancel();
  rest.cancel();
  in.clear();
  parser.reset();
  paused = std::chrono::milliseconds{0};
}

AsyncEventStream::AsyncEventStream(boost::asio::io_context& io, std::string host,
                                   std::uint16_t port, ClientLimits limits)
    : AsyncEventStream(io, Url{std::move(host), port}, limits) {}

AsyncEventStream::AsyncEventStream(boost::asio::io_context& io, const Url& url, ClientLimits limits,
                                   const tls::Trust& trust)
    : impl_(std::make_shared<Impl>(io, url, limits, trust)) {}

AsyncEventStream::~AsyncEventStream() { close(); }

void AsyncEventStream::open(const ClientRequest& request, Handlers handlers) {
  impl_->begin(request, std::move(handlers));
}

void AsyncEventStream::close() {
  impl_->drop();
  impl_->handlers = nullptr;
}

void AsyncEventStream::pause(std::chrono::milliseconds time) { impl_->paused = time; }

}  // namespace chorus::http
