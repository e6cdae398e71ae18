// NatNet's command channel without a socket: decides who is a client and what to answer.
//
// A client is an address that connected or sent a keep-alive, and then sent another message in
// time. (In multicast, connecting only asks for the server's settings, so only keeping alive
// counts.) Clients are identified by address and port; their number is limited in total and per
// host; they are forgotten after `client_timeout` without a message. Sender addresses can be
// forged, and the protocol cannot detect that. Answers are larger than requests, so `answers`
// limits their total. A single datagram enables nothing and takes no client's place. But two
// datagrams with the same forged address make us send frames to that host, for `client_timeout` and
// to at most `max_clients_per_address` ports (docs/decisions/0025). Messages that only servers send
// are never answered, so two servers cannot be made to answer each other.
#pragma once

#include <chrono>
#include <compare>
#include <deque>
#include <map>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/net/token_bucket.h"
#include "common/time/timestamp.h"
#include "fusion-server/natnet/natnet_messages.h"

namespace chorus::natnet {

/// An IPv4 address; the protocol supports nothing else.
struct Address {
  std::uint32_t host = 0;
  std::uint16_t port = 0;

  auto operator<=>(const Address&) const = default;
};

struct DeskOptions {
  ServerInfo info;
  Bytes models;  ///< The whole message with the model definitions.
  std::size_t max_clients = 16;
  std::size_t max_clients_per_address = 4;
  Duration client_timeout = std::chrono::seconds(10);
  net::Allowance answers{262'144.0, 524'288.0};  ///< In bytes.
};

struct Now {
  SteadyTime steady{};
  Timestamp utc{};
};

struct Reply {
  Bytes bytes;               ///< Empty: no answer.
  std::string_view refusal;  ///< Why the request was refused; empty if it was accepted.
};

class CommandDesk {
 public:
  explicit CommandDesk(DeskOptions options);

  [[nodiscard]] Reply answer(std::span<const char> datagram, const Address& from, const Now& now);

  /// Sets the model definitions, as a whole message.
  void describe(Bytes models) { options_.models = std::move(models); }

  /// Sets the frame that is sent on request.
  void newest(std::shared_ptr<const Bytes> frame, Timestamp instant);

  /// The clients that get frames at present.
  [[nodiscard]] std::vector<Address> clients(SteadyTime now);

 private:
  [[nodiscard]] Reply reply_to(const Incoming& request, const Now& now) const;
  [[nodiscard]] Bytes reply_to_text(std::string_view text) const;
  /// Why the sender cannot become a client; empty if it can, or does not ask to.
  [[nodiscard]] std::string_view admit(const Incoming& request, const Address& from,
                                       SteadyTime now);
  [[nodiscard]] std::string_view objection(const Address& from) const;
  void knock(const Address& from, SteadyTime now);
  [[nodiscard]] float frame_rate() const;
  void expire(SteadyTime now);

  DeskOptions options_;
  using Heard = std::map<Address, SteadyTime>;

  Heard heard_;   ///< Clients and when their last message came.
  Heard knocks_;  ///< Addresses that asked for frames once, and when; old ones are removed now and
                  ///< then.
  SteadyTime tidied_{};
  std::shared_ptr<const Bytes> frame_;
  std::deque<Timestamp> instants_;  ///< Instants of the newest frames.
  net::TokenBucket allowance_;
};

}  // namespace chorus::natnet
