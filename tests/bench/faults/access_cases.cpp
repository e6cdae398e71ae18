// Who may read and who may write: proxies, pages of other origins, guessed tokens.
#include <chrono>
#include <filesystem>

#include <fmt/format.h>

#include "common/http/status.h"
#include "tests/bench/faults/sockets.h"
#include "tests/bench/faults/trial.h"
#include "tests/bench/live/nginx_proxy.h"
#include "tests/support/free_port.h"

namespace chorus::bench {
namespace {

constexpr std::string_view kToken = "0123456789abcdef0123456789abcdef";

CellPlan with_token() {
  CellPlan plan;
  plan.fusion = {fmt::format("http.bearer_token={}", kToken)};
  return plan;
}

std::string request_of(std::string_view method, std::string_view path, std::string_view headers) {
  return fmt::format("{} {} HTTP/1.1\r\n{}Content-Length: 0\r\nConnection: close\r\n\r\n", method,
                     path, headers);
}

std::string bearer(std::string_view token) {
  return fmt::format("Host: 127.0.0.1\r\nAuthorization: Bearer {}\r\n", token);
}

bool is_refused(int status) { return status == 401 || status == 403; }

Result<void> same_host_proxy(Trial& trial) {
  if (!std::filesystem::exists(kNginx))
    return trial.leave_out("nginx is not installed"), Result<void>{};
  auto cell = Cell::start(with_token());
  if (!cell) return pass(cell);
  const End proxy{.port = testing::free_port()};
  const auto nginx =
      start_proxy({.folder = cell->folder(), .port = proxy.port, .upstream = cell->port()});
  if (!nginx) return pass(nginx);
  const auto ask = [&](std::string_view method, std::string_view path, std::string_view headers) {
    return status_of(head_of_answer(proxy, request_of(method, path, headers)));
  };
  const auto passes = [&] { return ask("GET", "/frame", "Host: 127.0.0.1\r\n") == 200; };
  if (!wait_until(5.0, passes))
    return fail(ErrorCode::Timeout, "nginx", "nothing is read through it");
  for (const auto& [method, path] : {std::pair{"POST", "/registration"},
                                     {"DELETE", "/registration"},
                                     {"POST", "/recordings/"}}) {
    const int status = ask(method, path, "Host: 127.0.0.1\r\n");
    trial.check(is_refused(status),
                fmt::format("{} {} through nginx without the token: {}", method, path, status));
  }
  const int allowed = ask("POST", "/registration", bearer(kToken));
  trial.check(allowed / 100 == 2 || allowed == http::status::kConflict,
              fmt::format("with the token: {}", allowed));
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

Result<void> token_on_loopback(Trial& trial) {
  auto cell = Cell::start(with_token());
  if (!cell) return pass(cell);
  const int without = cell->ask({"POST", "/registration"}).status;
  trial.check(is_refused(without), fmt::format("without the token that is set: {}", without));
  const auto with =
      head_of_answer({.port = cell->port()}, request_of("POST", "/registration", bearer(kToken)));
  trial.check(status_of(with) / 100 == 2 || status_of(with) == http::status::kConflict,
              fmt::format("with it: {}", status_of(with)));
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

bool lets_others_read(std::string_view head) {
  std::string lower(head);
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::size_t at = lower.find("access-control-allow-origin:");
  if (at == std::string::npos) return false;
  const std::string value = lower.substr(at, lower.find("\r\n", at) - at);
  return value.find('*') != std::string::npos || value.find("evil") != std::string::npos;
}

Result<void> foreign_page(Trial& trial) {
  auto cell = Cell::start({.sensors = 2});
  if (!cell) return pass(cell);
  const End end{.port = cell->port()};
  const std::string host = fmt::format("Host: 127.0.0.1:{}\r\n", end.port);
  for (const auto* path : {"/frame", "/registration", "/sensors/", "/images/color"}) {
    const auto head =
        head_of_answer(end, request_of("GET", path, host + "Origin: http://evil.example\r\n"));
    trial.check(!lets_others_read(head), fmt::format("{} may not be read by any page", path));
  }
  const auto own = head_of_answer(
      end,
      request_of("GET", "/frame", host + fmt::format("Origin: http://127.0.0.1:{}\r\n", end.port)));
  trial.check(status_of(own) == 200, "our own page reads /frame");
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

Result<void> foreign_host_name(Trial& trial) {
  auto cell = Cell::start({.sensors = 2});
  if (!cell) return pass(cell);
  const End end{.port = cell->port()};
  const auto status = [&](const std::string& host) {
    return status_of(head_of_answer(end, request_of("GET", "/frame", "Host: " + host + "\r\n")));
  };
  const int rebound = status(fmt::format("evil.example:{}", end.port));
  trial.check(rebound / 100 == 4, fmt::format("Host: evil.example on loopback: {}", rebound));
  const int own = status(fmt::format("localhost:{}", end.port));
  trial.check(own == 200, fmt::format("Host: localhost: {}", own));
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

Result<void> foreign_websocket(Trial& trial) {
  auto cell = Cell::start({.sensors = 2});
  if (!cell) return pass(cell);
  const End end{.port = cell->port()};
  const auto opened = [&](const std::string& origin) {
    return status_of(head_of_answer(
        end, fmt::format("GET /frame HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nConnection: Upgrade\r\n"
                         "Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nOrigin: {}\r\n"
                         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n",
                         end.port, origin)));
  };
  const int foreign = opened("http://evil.example");
  trial.check(foreign != 101 && foreign != 0, fmt::format("of another page: {}", foreign));
  const int own = opened(fmt::format("http://127.0.0.1:{}", end.port));
  trial.check(own == 101, fmt::format("of our own page: {}", own));
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

/// A host may try ten tokens at once and then one a second, because the answers to wrong ones wait.
/// The test counts the guesses that are answered during kGuessing.
Result<void> guessed_tokens(Trial& trial) {
  constexpr double kGuessing = 4.0;       // [s]
  constexpr int kMaxJudged = 10 + 4 + 2;  // at once, one a second, and two to spare
  const auto host = foreign_address();
  if (!host) return trial.leave_out("this host has no address beside loopback"), Result<void>{};
  CellPlan plan = with_token();
  plan.address = "0.0.0.0";
  auto cell = Cell::start(plan);
  if (!cell) return pass(cell);
  const Timestamp begun = now();
  int judged = 0;
  int guesses = 0;
  while (seconds(now() - begun) < kGuessing) {
    const std::string guess = bearer(fmt::format("wrong {}", guesses));
    const auto answer =
        head_of_answer({*host, cell->port()}, request_of("POST", "/registration", guess));
    judged += status_of(answer) == 401 ? 1 : 0;
    ++guesses;
  }
  trial.check(judged <= kMaxJudged,
              fmt::format("of {} guesses in {} s {} are judged", guesses, kGuessing, judged));
  const Timestamp asked = now();
  const auto own =
      head_of_answer({.port = cell->port()}, request_of("POST", "/registration", bearer(kToken)));
  trial.check(status_of(own) / 100 == 2 && seconds(now() - asked) < 1.0,
              fmt::format("another host with the right one is served at once: {}", status_of(own)));
  trial.rss_mb = cell->fusion().resident_mb();
  return {};
}

}  // namespace

FaultCases access_cases() {
  return {
      {"proxy-same-host", "nginx in front that forwards no header", same_host_proxy},
      {"token-loopback", "a token is set: it is wanted from this host too", token_on_loopback,
       true},
      {"foreign-page", "a web page of another origin reads", foreign_page},
      {"foreign-host-name", "a name that DNS points at loopback", foreign_host_name, true},
      {"foreign-websocket", "a web page of another origin opens a WebSocket", foreign_websocket,
       true},
      {"guessed-tokens", "another host tries tokens as fast as it can", guessed_tokens},
  };
}

}  // namespace chorus::bench
