// One client: reads requests one after the other, writes answers in order, waits for publishes.
//
// Everything runs on the server's only thread.  At most one read and one write are under way.
// Deadlines are swept by the server (a timer per request costs 2 us), so they are exact to a
// quarter of a second.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "common/http/asio.h"
#include "common/http/responder.h"
#include "common/http/session.h"

namespace chorus::http {

struct ServerCore;

class Connection final : public Session {
 public:
  Connection(ServerCore& core, Socket socket, const tcp::endpoint& remote);

  void start();
  /// There are too many connections: answers one request, if it is for something vital, and closes.
  void start_in_reserve();
  void wake() override;
  void expire() override;
  void stop() override;
  void close() override;
  [[nodiscard]] bool idle() const override;

 private:
  enum class State { Head, Body, Writing, Waiting, Streaming, Lingering, Closed };

  void read();
  void on_read(error_code failed, std::size_t size);
  void advance();
  void make_room();
  void refuse(int status, std::string detail);
  void serve(std::size_t head_size);
  void begin_body();
  void advance_body();
  [[nodiscard]] bool may_ask();
  void refuse_for_now(std::string detail);
  void send(Answer answer);
  [[nodiscard]] bool begin_download();
  void end_download();
  void on_sent(error_code failed, std::size_t size);
  bool send_piece();
  void next_request();
  void linger();
  void begin_wait();
  void wait_on();
  void end_wait(Answer answer);
  void watch();
  void begin_stream();
  void push_event();
  void on_event_sent(error_code failed, std::size_t size);
  void event_done();
  void upgrade();
  void expire_in(std::chrono::seconds time);
  [[nodiscard]] std::shared_ptr<Connection> self() {
    return std::static_pointer_cast<Connection>(shared_from_this());
  }
  [[nodiscard]] std::string_view unread() const { return {buffer_.get() + begin_, end_ - begin_}; }

  ServerCore& core_;
  Socket socket_;
  Peer peer_;
  State state_ = State::Head;
  bool reading_ = false;
  bool end_of_input_ = false;
  bool close_after_ = false;
  bool in_reserve_ = false;
  bool downloading_ = false;

  std::unique_ptr<char[]> buffer_;  ///< One head at most; what follows it stays in the kernel.
  std::size_t capacity_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t checked_ = 0;  ///< Of unread(): has no end of a head.
  std::size_t request_size_ = 0;
  std::size_t drained_ = 0;

  RequestHead head_;
  Reaction reaction_;
  Answer answer_;
  std::uint64_t sent_of_file_ = 0;
  std::string piece_;  ///< Of the answer's file.
  Timestamp received_;
  std::string first_lines_;
  std::string body_;

  DocumentPtr streamed_;  ///< Last document sent as an event.
  std::shared_ptr<const std::string> event_;
  bool event_under_way_ = false;
  bool event_pending_ = false;
};

}  // namespace chorus::http
