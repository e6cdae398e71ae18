// One client's requests and our answers, as a state machine without IO: it takes events and returns
// orders (orders.h).
//
// Requests are read one after the other and answered in order; what a client sends ahead waits in
// the buffer.  Long polls and event streams wait for publishes.  Time is an argument; the Asio
// shell (http_connection.h) carries the orders out and feeds their outcome back.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/base/duration.h"
#include "common/http/conversation_context.h"
#include "common/http/download.h"
#include "common/http/live_reader.h"
#include "common/http/orders.h"
#include "common/http/request_buffer.h"
#include "common/http/responder.h"

namespace chorus::http {

class Conversation {
 public:
  /// Counts the connection for the account that a trusted proxy names; false when that account has
  /// too many connections.
  using Charge = std::function<bool(const std::string& account)>;

  Conversation(ConversationContext context, Peer peer, Charge charge);

  /// Call this before begin() when the client speaks without TLS to a server that requires it.  Its
  /// request is then refused, with advice to use https.
  void expect_tls() { expects_tls_ = true; }

  [[nodiscard]] Orders begin(SteadyTime now);
  /// Call this instead of begin() when there are too many connections: answers one request, with
  /// 503 unless its path is vital.
  [[nodiscard]] Orders begin_in_reserve(SteadyTime now);
  [[nodiscard]] Orders received(std::size_t size, SteadyTime now);
  /// `cleanly`: the client has closed its sending side; otherwise the connection is broken.
  [[nodiscard]] Orders input_ended(bool cleanly, SteadyTime now);
  [[nodiscard]] Orders sent(std::size_t size, SteadyTime now);
  [[nodiscard]] Orders send_failed(std::size_t size, SteadyTime now);
  [[nodiscard]] Orders settled(SteadyTime now);
  /// Call this when a new version of the entry's document was published and the wait is no longer
  /// registered.
  [[nodiscard]] Orders woken(SteadyTime now);
  /// Call this when the wait has just been registered: checks for a version published before that.
  /// `newest`: what a stream takes for the newest version; null: what the entry has.
  [[nodiscard]] Orders look(SteadyTime now, DocumentPtr newest = nullptr);
  [[nodiscard]] Orders expired(SteadyTime now);
  /// The server is stopping: finishes the body or answer under way, refuses a waiting long poll,
  /// and otherwise hangs up.
  [[nodiscard]] Orders stop(SteadyTime now);
  [[nodiscard]] Orders close(SteadyTime now);

  [[nodiscard]] std::span<char> room() { return buffer_.room(); }
  [[nodiscard]] const std::array<std::string_view, 4>& output() const { return output_; }
  /// The request that asked for an upgrade, in the form that Beast reads: see handshake_of.
  [[nodiscard]] std::string handshake() const;
  /// The reaction's entry says which document to wait for, or which WebSocket to upgrade to.
  [[nodiscard]] const Reaction& reaction() const { return reaction_; }
  [[nodiscard]] SteadyTime deadline() const { return deadline_; }
  [[nodiscard]] bool closed() const { return state_ == State::Closed; }
  /// True between requests.
  [[nodiscard]] bool idle() const;

 private:
  [[nodiscard]] std::string_view unread() const { return buffer_.unread(); }
  /// Held: the client has asked too much lately, and its request waits; Delayed: its answer does.
  enum class State { Head, Held, Body, Delayed, Writing, Waiting, Streaming, Lingering, Closed };

  template <class Event>
  Orders resume(SteadyTime now, const Event& event);
  void read();
  void on_input(std::size_t size);
  void advance();
  void refuse(int status, std::string detail);
  void serve(std::size_t head_size);
  [[nodiscard]] bool may_ask();
  [[nodiscard]] bool is_exempt() const;
  void begin_body();
  void advance_body();
  void send(Answer answer);
  void write(std::string_view bytes);
  void answer_sent();
  [[nodiscard]] bool send_piece();
  void next_request();
  void linger();
  void begin_wait();
  void on_woken();
  void on_look(DocumentPtr newest);
  void on_settled();
  void end_wait(Answer answer);
  void watch();
  void begin_stream();
  void push_event(DocumentPtr newest = nullptr);
  void answer();
  void send_now();
  void on_deadline();
  void on_stop();
  void hang_up();
  void expire_in(std::chrono::seconds time) { deadline_ = now_ + time; }

  ConversationContext context_;
  Peer peer_;
  Charge charge_;
  State state_ = State::Head;
  SteadyTime now_{};
  SteadyTime deadline_{};
  Orders orders_;
  bool reading_ = false;
  bool end_of_input_ = false;
  bool close_after_ = false;
  bool in_reserve_ = false;
  bool expects_tls_ = false;
  bool continuing_ = false;  ///< "100 Continue" is being written.
  RequestBuffer buffer_;
  std::size_t request_size_ = 0;
  std::size_t drained_ = 0;

  RequestHead head_;
  Reaction reaction_;
  Answer answer_;
  std::array<std::string_view, 4> output_;
  Download download_;  ///< Of the answer's file.
  Timestamp received_;
  std::string first_lines_;
  std::string body_;

  std::optional<LiveReader> reader_;  ///< Of the stream.
  std::shared_ptr<const std::string> event_;
  bool event_under_way_ = false;
  bool event_pending_ = false;
};

}  // namespace chorus::http
