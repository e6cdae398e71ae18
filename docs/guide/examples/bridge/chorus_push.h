// Pushes frames of any tracker to a chorus-sensor whose device is `bridge`: one header, sockets and nothing else.  C++17.
//
//   chorus::Pusher pusher("127.0.0.1:8081", R"({"type":"hello","name":"my camera","layout":"azure_kinect_32","axes":"right down ahead"})");
//   chorus::Frame frame(captured_ns);                 // nanoseconds since 1970, by the clock that chorus::now_ns() reads
//   frame.body(7);
//   for (const auto& j : joints) frame.point(j.x, j.y, j.z, j.confidence);   // in the layout's order, metres; missing() for none
//   if (!pusher.push(frame)) std::cerr << pusher.problem() << "\n";
//
// A sensor with TLS is wss://HOST:PORT, for which this needs chorus_push_tls.h beside it and OpenSSL: -DCHORUS_PUSH_TLS, -lssl -lcrypto.
//
// What the messages mean: proto/bridge.md.  Tested on Linux; the lines for Windows are there and were never compiled.
#pragma once

#ifdef _WIN32
#include <winsock2.h>
#include <ws2tcpip.h>
#else
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>

namespace chorus {

/// This computer's UTC [ns]; it need not be right, but frames have to be stamped by it.
inline std::int64_t now_ns() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

/// One frame: nobody is seen unless a body is begun.
class Frame {
 public:
  explicit Frame(std::int64_t captured_ns) : captured_ns_(captured_ns) {}

  /// Begins a body whose landmarks follow.
  void body(std::uint64_t id) {
    end_body();
    bodies_ += (bodies_.empty() ? "{\"id\":" : ",{\"id\":") + std::to_string(id) + ",\"points\":[";
    open_ = first_ = true;
  }
  /// The next landmark [m]; not finite is the same as missing.
  void point(double x, double y, double z, double confidence = 1.0) {
    if (!std::isfinite(x + y + z + confidence)) return missing();
    char text[128];
    std::snprintf(text, sizeof text, "[%.4f,%.4f,%.4f,%.3f]", x, y, z, confidence);
    add(text);
  }
  void missing() { add("null"); }

  /// The message, without a line feed.
  std::string text(std::uint64_t sequence) {
    end_body();
    return "{\"type\":\"frame\",\"sequence\":" + std::to_string(sequence) + ",\"captured\":\"" +
           std::to_string(captured_ns_) + "\",\"bodies\":[" + bodies_ + "]}";
  }

 private:
  void add(const char* landmark) {
    if (!first_) bodies_ += ',';
    bodies_ += landmark;
    first_ = false;
  }
  void end_body() {
    if (open_) bodies_ += "]}";
    open_ = false;
  }
  std::int64_t captured_ns_;
  std::string bodies_;
  bool open_ = false;
  bool first_ = true;
};

/// A connected stream of bytes: TCP, or a local socket where the address is a path.
class Stream {
 public:
  ~Stream() { close(); }
  bool is_open() const { return socket_ >= 0; }
  bool is_local() const { return local_; }

  bool open(const std::string& where) {
    local_ = where.find('/') != std::string::npos;
    return local_ ? open_path(where) : open_host(where);
  }
  bool send(const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const auto n = ::send(socket_, bytes.data() + sent, bytes.size() - sent, kNoSignal);
      if (n <= 0) return false;
      sent += static_cast<std::size_t>(n);
    }
    return true;
  }
  /// Appends the bytes that have arrived; waits at most `patience_ms` for the first. False at the end.
  bool receive(std::string& bytes, int patience_ms) {
    pollfd ready{};
    ready.fd = socket_;
    ready.events = POLLIN;
    if (poll_one(ready, patience_ms) <= 0) return true;
    char chunk[4096];
    const auto n = ::recv(socket_, chunk, sizeof chunk, 0);
    if (n <= 0) return false;
    bytes.append(chunk, static_cast<std::size_t>(n));
    return true;
  }
#ifdef _WIN32
  void close() {
    if (is_open()) ::closesocket(socket_);
    socket_ = -1;
  }

 private:
  static constexpr int kNoSignal = 0;
  static int poll_one(pollfd& ready, int ms) { return ::WSAPoll(&ready, 1, ms); }
  bool open_path(const std::string&) { return false; }
#else
  void close() {
    if (is_open()) ::close(socket_);
    socket_ = -1;
  }

 private:
  static constexpr int kNoSignal = MSG_NOSIGNAL;
  static int poll_one(pollfd& ready, int ms) { return ::poll(&ready, 1, ms); }
  bool open_path(const std::string& path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::snprintf(address.sun_path, sizeof address.sun_path, "%s", path.c_str());
    return open_to(AF_UNIX, reinterpret_cast<sockaddr*>(&address), sizeof address);
  }
#endif
  bool open_host(const std::string& where) {
#ifdef _WIN32
    static const bool started = [] { WSADATA about; return ::WSAStartup(MAKEWORD(2, 2), &about) == 0; }();
    if (!started) return false;
#endif
    const std::size_t colon = where.rfind(':');
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    const std::string port = colon == std::string::npos ? "8081" : where.substr(colon + 1);
    if (::getaddrinfo(where.substr(0, colon).c_str(), port.c_str(), &wanted, &found) != 0) return false;
    for (const addrinfo* one = found; one != nullptr && !is_open(); one = one->ai_next)
      open_to(one->ai_family, one->ai_addr, one->ai_addrlen);
    ::freeaddrinfo(found);
    const int on = 1;
    if (is_open()) ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, reinterpret_cast<const char*>(&on), sizeof on);
    return is_open();
  }
  template <class Size>
  bool open_to(int family, const sockaddr* address, Size size) {
    socket_ = static_cast<int>(::socket(family, SOCK_STREAM, 0));
    if (is_open() && ::connect(socket_, address, static_cast<socklen_t>(size)) == 0) return true;
    close();
    return false;
  }
  int socket_ = -1;
  bool local_ = false;
};

}  // namespace chorus

#ifdef CHORUS_PUSH_TLS
#include "chorus_push_tls.h"
#endif

namespace chorus {

#ifndef CHORUS_PUSH_TLS
/// In place of chorus_push_tls.h: says how to have it.
class Tls {
 public:
  bool is_open() const { return false; }
  void close() {}
  std::string open(Stream&, const std::string&, const std::string&, int) { return "this program was compiled without CHORUS_PUSH_TLS"; }
  bool send(Stream&, const std::string&) { return false; }
  bool receive(Stream&, std::string&, int) { return false; }
};
#endif

class Pusher {
 public:
  /// `where`: HOST:PORT, ws://HOST:PORT, wss://HOST:PORT, or the path of a local socket.  `hello`: the message, as JSON in one line.
  /// `ca`: a file of authorities to believe, for wss; empty: that of CHORUS_CA, else the system's.
  Pusher(std::string where, std::string hello, std::string token = "", std::string ca = "")
      : where_(std::move(where)), hello_(std::move(hello)), token_(std::move(token)), ca_(std::move(ca)) {
    sealed_ = where_.compare(0, 6, "wss://") == 0;
    if (sealed_ || where_.compare(0, 5, "ws://") == 0) {  // without the path, which is known
      where_.erase(0, where_.find("//") + 2);
      where_.erase(std::min(where_.find('/'), where_.size()));
    }
    const char* const named = std::getenv("CHORUS_CA");
    if (ca_.empty() && named != nullptr) ca_ = named;
  }

  /// Returns false if the frame was not sent; problem() says why, and a push at least a second after the last attempt connects
  /// again. Also answers the sensor's questions for the time: push at least twice a second, an empty frame if nobody is there.
  bool push(Frame& frame) {
    ++sequence_;
    if (!stream_.is_open()) {
      const auto now = std::chrono::steady_clock::now();
      if (now - tried_ < std::chrono::seconds(1)) return false;
      tried_ = now;
    }
    problem_.clear();
    if (!stream_.is_open() && !connect()) return false;
    return send(frame.text(sequence_)) && listen(0);
  }
  /// What the sensor complained about last, or why it cannot be reached; empty: nothing.
  const std::string& problem() const { return problem_; }

 private:
  bool connect() {
    heard_.clear();
    greeted_ = false;
    if (where_.compare(0, 4, "http") == 0 && where_.find("://") != std::string::npos)
      return fail(where_ + ": this program speaks WebSocket: write HOST:PORT, ws://HOST:PORT or wss://HOST:PORT");
    if (!stream_.open(where_)) return fail("cannot connect to " + where_ + ": is the sensor running, and is the address right?");
    if (sealed_) {
      const std::string wrong = tls_.open(stream_, where_.substr(0, where_.rfind(':')), ca_, kPatienceMs);
      if (!wrong.empty()) return fail(where_ + ": " + wrong);
    }
    if (!stream_.is_local() && !shake_hands()) return fail(problem_);
    if (!send(hello_)) return false;
    while (!greeted_) {  // the welcome comes with the first question for the time
      if (!listen(kPatienceMs)) return false;
      if (!greeted_) return fail(problem_.empty() ? "no welcome came" : problem_);
    }
    return true;
  }
  /// Opens the WebSocket.
  bool shake_hands() {
    std::string asked = "GET /push HTTP/1.1\r\nHost: " + where_ +
                        "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                        "Sec-WebSocket-Key: Y2hvcnVzLWMrKy1wdXNoZXI=\r\n";
    if (!token_.empty()) asked += "Authorization: Bearer " + token_ + "\r\n";
    std::size_t end = std::string::npos;
    if (send_bytes(asked + "\r\n")) {
      while ((end = heard_.find("\r\n\r\n")) == std::string::npos) {
        const std::size_t before = heard_.size();
        if (!receive(kPatienceMs) || heard_.size() == before) break;
      }
    }
    problem_ = heard_.empty() ? "no answer from " + where_
                              : where_ + ": " + heard_.substr(0, heard_.find("\r\n")) + ": " +
                                    (end == std::string::npos ? "" : heard_.substr(end + 4));
    if (end == std::string::npos || heard_.compare(0, 12, "HTTP/1.1 101") != 0) return false;
    problem_.clear();
    heard_.erase(0, end + 4);
    return true;
  }
  bool send_bytes(const std::string& bytes) { return sealed_ ? tls_.send(stream_, bytes) : stream_.send(bytes); }
  bool receive(int patience_ms) {
    return sealed_ ? tls_.receive(stream_, heard_, patience_ms) : stream_.receive(heard_, patience_ms);
  }
  bool send(const std::string& message) {
    if (send_bytes(stream_.is_local() ? message + "\n" : frame_of(message))) return true;
    return fail("the sensor has gone");
  }
  /// A masked text frame; the mask is zero, which changes nothing.
  static std::string frame_of(const std::string& text, unsigned char opcode = 1) {
    std::string frame(1, static_cast<char>(0x80 | opcode));
    const std::size_t size = text.size();
    const int bytes = size < 126 ? 0 : size < 65536 ? 2 : 8;
    frame += static_cast<char>(0x80 | (bytes == 0 ? size : bytes == 2 ? 126u : 127u));
    for (int i = bytes - 1; i >= 0; --i) frame += static_cast<char>(static_cast<std::uint64_t>(size) >> (8 * i) & 0xFF);
    return frame + std::string(4, '\0') + text;
  }
  bool listen(int patience_ms) {
    if (!receive(patience_ms)) return fail(problem_.empty() ? "the sensor closed the connection" : problem_);
    const std::int64_t received = now_ns();
    for (std::string message; next(message);) {
      if (!hear(message, received)) return false;
    }
    return true;
  }
  /// Takes the next whole message out of what was heard; the sensor sends only short ones.
  bool next(std::string& message) {
    if (stream_.is_local()) {
      const std::size_t end = heard_.find('\n');
      if (end == std::string::npos) return false;
      message = heard_.substr(0, end);
      heard_.erase(0, end + 1);
      return true;
    }
    if (heard_.size() < 2) return false;
    const auto byte = [this](std::size_t i) { return static_cast<unsigned char>(heard_[i]); };
    const bool long_one = (byte(1) & 0x7F) == 126;
    const std::size_t begin = long_one ? 4 : 2;
    if (heard_.size() < begin) return false;
    const std::size_t size = long_one ? byte(2) * 256u + byte(3) : byte(1) & 0x7Fu;
    if (heard_.size() < begin + size) return false;
    const int opcode = byte(0) & 0x0F;
    message = opcode == 1 ? heard_.substr(begin, size) : "";
    if (opcode == 9) send_bytes(frame_of(heard_.substr(begin, size), 10));
    heard_.erase(0, begin + size);
    return true;
  }
  bool hear(const std::string& message, std::int64_t received) {
    const std::string type = value(message, "type");
    if (type == "clock") {
      return send("{\"type\":\"clock\",\"sent\":\"" + value(message, "sent") + "\",\"received\":\"" + std::to_string(received) +
                  "\",\"answered\":\"" + std::to_string(now_ns()) + "\"}");
    }
    if (type == "welcome") greeted_ = true;
    if (type == "error" || type == "bye") problem_ = message;
    return true;
  }
  /// The string at a key; the sensor writes it without spaces around the colon and without escapes.
  static std::string value(const std::string& json, const std::string& key) {
    const std::string mark = "\"" + key + "\":\"";
    const std::size_t at = json.find(mark);
    if (at == std::string::npos) return {};
    const std::size_t begin = at + mark.size();
    return json.substr(begin, json.find('"', begin) - begin);
  }
  bool fail(std::string why) {
    problem_ = std::move(why);
    tls_.close();
    stream_.close();
    return false;
  }

  static constexpr int kPatienceMs = 2000;
  std::string where_;
  std::string hello_;
  std::string token_;
  std::string ca_;
  bool sealed_ = false;
  Stream stream_;
  Tls tls_;
  std::string heard_;
  std::string problem_;
  bool greeted_ = false;
  std::chrono::steady_clock::time_point tried_{};
  std::uint64_t sequence_ = 0;
};

}  // namespace chorus
