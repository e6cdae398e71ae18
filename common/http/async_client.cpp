#include <algorithm>
#include <optional>

#include "common/http/beast.h"
#include "common/http/client.h"
#include "common/http/client_wire.h"
#include "common/http/status.h"
#include "common/net/connect.h"
#include "common/net/stream.h"
#include "common/time/clock.h"

namespace chorus::http {
namespace {

namespace beast = boost::beast;
using Parser = beast::http::response_parser<beast::http::string_body>;

/// Limits what has come and cannot be parsed yet: a head, or that of a chunk, which Beast does not
/// limit by itself.
constexpr std::size_t kMaxUnparsed = 131072;

}  // namespace

struct AsyncClient::Impl : std::enable_shared_from_this<AsyncClient::Impl> {
  Impl(asio::io_context& io, const Url& to, ClientLimits with, tls::Trust believing)
      : host(to.host),
        port(to.port),
        secure(to.secure),
        trust(std::move(believing)),
        limits(with),
        authority(authority_of(host, port)),
        executor(io.get_executor()),
        resolver(executor),
        stream(executor),
        timer(executor) {}

  void begin(ClientRequest request, std::chrono::milliseconds answer_timeout, Callback on_done);
  void connect();
  void seal();
  void write();
  void read();
  void on_head(net::error_code failed);
  void on_failed_read(net::error_code failed);
  void on_answer();
  void too_large();
  void retry_or_fail(net::error_code failed, std::string_view doing);
  void finish(Result<ClientResponse> result);
  void finish_later(Error error);
  void arm(std::chrono::milliseconds time, std::string_view doing);
  void drop();

  const std::string host;
  const std::uint16_t port;
  const bool secure;
  const tls::Trust trust;
  const ClientLimits limits;
  const std::string authority;
  net::Executor executor;
  net::Resolver resolver;
  net::Stream stream;
  net::Timer timer;

  Callback callback;          ///< Set while a request is under way.
  std::uint64_t attempt = 0;  ///< Handlers that belong to an older attempt do nothing.
  bool connected = false;
  bool reused = false;  ///< The connection has answered before, so the server may have closed it.
  bool closed = false;
  bool repeatable = false;
  bool head_only = false;
  std::string out;
  std::chrono::milliseconds answer_time{0};
  beast::flat_buffer in{kMaxUnparsed};
  std::optional<Parser> parser;
  std::int64_t sent_ns = 0;
};

void AsyncClient::Impl::begin(ClientRequest request, std::chrono::milliseconds answer_timeout,
                              Callback on_done) {
  if (closed) return;
  if (callback) {
    asio::post(executor, [self = shared_from_this(), on_done] {
      if (!self->closed)
        on_done(fail(ErrorCode::Conflict, self->authority, "a request is under way already"));
    });
    return;
  }
  callback = std::move(on_done);
  ++attempt;
  if (!is_writable(request))
    return finish_later({ErrorCode::InvalidArgument, authority,
                         "a method or target has no spaces, and a header field no line breaks"});
  head_only = request.method == "HEAD";
  repeatable = request.method == "GET" || head_only;
  answer_time = answer_timeout;
  out = request_text(request, authority);
  reused = connected;
  if (connected) return write();
  connect();
}

void AsyncClient::Impl::connect() {
  drop();
  reused = false;
  arm(limits.connect_timeout, "connect");
  net::Connecting to{host, port,
                     [self = shared_from_this(), mine = attempt] { return self->attempt == mine; }};
  net::connect_to(std::move(to), resolver, stream.socket(),
                  [self = shared_from_this()](net::error_code failed, std::string_view doing) {
                    if (failed) return self->retry_or_fail(failed, doing);
                    if (self->secure) return self->seal();
                    self->connected = true;
                    self->write();
                  });
}

void AsyncClient::Impl::seal() {
  arm(limits.connect_timeout, "TLS handshake");
  stream.seal_as_client(
      trust, host,
      [self = shared_from_this(), mine = attempt](const net::Stream::Sealing& sealing) {
        if (self->attempt != mine) return;
        if (sealing.failure)
          return self->finish(
              fail(sealing.failure->code, self->authority, sealing.failure->message));
        self->connected = true;
        self->write();
      });
}

void AsyncClient::Impl::write() {
  arm(answer_time, "answer");
  sent_ns = to_unix_ns(SystemClock().now());
  asio::async_write(
      stream, asio::buffer(out),
      [self = shared_from_this(), mine = attempt](net::error_code failed, std::size_t) {
        if (self->attempt != mine) return;
        if (failed) return self->retry_or_fail(failed, "send");
        self->read();
      });
}

void AsyncClient::Impl::read() {
  parser.emplace();
  parser->header_limit(kMaxAnswerHeadBytes);
  parser->body_limit(limits.max_body_bytes);
  parser->skip(head_only);
  in.reserve(kMaxAnswerHeadBytes);
  beast::http::async_read_header(
      stream, in, *parser,
      [self = shared_from_this(), mine = attempt](net::error_code failed, std::size_t) {
        if (self->attempt == mine) self->on_head(failed);
      });
}

void AsyncClient::Impl::on_head(net::error_code failed) {
  if (failed) return on_failed_read(failed);
  if (parser->get().result_int() < unsigned{status::kOk})
    return read();  // An interim answer, such as 100 Continue.
  // Beast 1.74 does not compare a response's Content-Length with its body limit.
  const auto length = parser->content_length();
  if (!head_only && length && *length > limits.max_body_bytes) return too_large();
  if (parser->is_done()) return on_answer();
  beast::http::async_read(
      stream, in, *parser,
      [self = shared_from_this(), mine = attempt](net::error_code body_failed, std::size_t) {
        if (self->attempt != mine) return;
        body_failed ? self->on_failed_read(body_failed) : self->on_answer();
      });
}

void AsyncClient::Impl::too_large() {
  finish(fail(ErrorCode::TooLarge, authority,
              "the answer is larger than " + std::to_string(limits.max_body_bytes) + " bytes"));
}

void AsyncClient::Impl::on_failed_read(net::error_code failed) {
  if (failed == beast::http::error::body_limit) return too_large();
  if (!parser->got_some()) return retry_or_fail(failed, "read the answer");
  const net::error_code cut_off = beast::http::error::partial_message;
  const bool broken = failed.category() == cut_off.category() && failed != cut_off;
  finish(fail(broken ? ErrorCode::Malformed : ErrorCode::Unavailable, authority,
              "the answer is broken or cut off: " + failed.message()));
}

void AsyncClient::Impl::on_answer() {
  ClientResponse response = response_of(parser->get().base());
  response.body = std::move(parser->get().body());
  response.sent_ns = sent_ns;
  response.received_ns = to_unix_ns(SystemClock().now());
  // Bytes after the answer do not belong to any request of ours.
  if (!parser->keep_alive() || in.size() > 0) drop();
  finish(std::move(response));
}

/// Repeats the request on a new connection if the server may have closed the kept-alive one;
/// otherwise fails.
void AsyncClient::Impl::retry_or_fail(net::error_code failed, std::string_view doing) {
  if (reused && repeatable) return connect();
  finish(fail(ErrorCode::Unavailable, authority,
              "cannot " + std::string(doing) + ": " + failed.message()));
}

void AsyncClient::Impl::arm(std::chrono::milliseconds time, std::string_view doing) {
  timer.expires_after(time);
  timer.async_wait(
      [self = shared_from_this(), mine = attempt, doing, time](net::error_code cancelled) {
        if (cancelled || self->attempt != mine || !self->callback) return;
        // The timer was set again after it had expired but before this handler ran; the newer wait
        // counts.
        if (self->timer.expiry() > std::chrono::steady_clock::now()) return;
        self->finish(
            fail(ErrorCode::Timeout, self->authority,
                 "no " + std::string(doing) + " within " + std::to_string(time.count()) + " ms"));
      });
}

void AsyncClient::Impl::finish(Result<ClientResponse> result) {
  ++attempt;
  if (!result) drop();
  timer.cancel();
  // The callback may send again, close or destroy the client.
  const Callback done = std::exchange(callback, nullptr);
  if (done) done(std::move(result));
}

void AsyncClient::Impl::finish_later(Error error) {
  asio::post(executor, [self = shared_from_this(), mine = attempt, error = std::move(error)] {
    if (self->attempt == mine) self->finish(tl::unexpected<Error>(error));
  });
}

void AsyncClient::Impl::drop() {
  resolver.cancel();
  stream.close();
  in.clear();
  connected = false;
}

AsyncClient::AsyncClient(boost::asio::io_context& io, std::string host, std::uint16_t port,
                         ClientLimits limits)
    : AsyncClient(io, Url{std::move(host), port}, limits) {}

AsyncClient::AsyncClient(boost::asio::io_context& io, const Url& url, ClientLimits limits,
                         const tls::Trust& trust)
    : impl_(std::make_shared<Impl>(io, url, limits, trust)) {}

AsyncClient::~AsyncClient() { close(); }

void AsyncClient::send(ClientRequest request, std::chrono::milliseconds answer_timeout,
                       Callback callback) {
  impl_->begin(std::move(request), answer_timeout, std::move(callback));
}

void AsyncClient::close() {
  impl_->closed = true;
  ++impl_->attempt;
  impl_->callback = nullptr;
  impl_->timer.cancel();
  impl_->drop();
}

}  // namespace chorus::http
