// NatNet's command channel without a socket: who is a client, and what is answered to whom.
//
// Clients are those that connected or keep alive (in multicast, where connecting only asks for the
// server's settings, those that keep alive) and then said something else.  They are few, of all
// hosts and of each, known by address and port, and forgotten when nothing is heard of them for
// `client_timeout`.
// Anybody can write in anybody's name, and the protocol has no means to tell.  Answers are larger
// than requests: all together get `answers`.  A single datagram turns on nothing and takes no
// client's place; two in one name still send frames to that host, for `client_timeout` and on at
// most `max_clients_per_address` ports (docs/decisions/0025).  What a
// server says is never answered, so two servers cannot be made to talk to each other.
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

#include "common/time/timestamp.h"
#include "fusion-server/natnet/natnet_messages.h"
#include "fusion-server/outlet/token_bucket.h"

namespace chorus::natnet {

/// IPv4: the protocol knows no other.
struct Address {
  std::uint32_t host = 0;
  std::uint16_t port = 0;

  auto operator<=>(const Address&) const = default;
};

struct DeskOptions {
  ServerInfo info;
  Bytes models;  ///< The whole message.
  std::size_t max_clients = 16;
  std::size_t max_clients_per_address = 4;
  Duration client_timeout = std::chrono::seconds(10);
  outlet::Allowance answers{262'144.0, 524'288.0};  ///< Bytes.
};

struct Now {
  outlet::SteadyTime steady{};
  Timestamp utc{};
};

struct Reply {
  Bytes bytes;               ///< Empty: nothing is said.
  std::string_view refusal;  ///< Why it was turned away; empty: it was not.
};

class CommandDesk {
 public:
  explicit CommandDesk(DeskOptions options);

  [[nodiscard]] Reply answer(std::span<const char> datagram, const Address& from, const Now& now);

  /// The descriptions from now on: the whole message.
  void describe(Bytes models) { options_.models = std::move(models); }

  /// The frame that is sent to those who ask for one.
  void newest(std::shared_ptr<const Bytes> frame, Timestamp instant);

  /// Who gets frames now.
  [[nodiscard]] std::vector<Address> clients(outlet::SteadyTime now);

 private:
  [[nodiscard]] Reply reply_to(const Incoming& request, const Now& now) const;
  [[nodiscard]] Bytes reply_to_text(std::string_view text) const;
  /// Why it cannot be a client; empty: it can, or does not want to.
  [[nodiscard]] std::string_view admit(const Incoming& request, const Address& from,
                                       outlet::SteadyTime now);
  [[nodiscard]] std::string_view objection(const Address& from) const;
  void knock(const Address& from, outlet::SteadyTime now);
  [[nodiscard]] float frame_rate() const;
  void expire(outlet::SteadyTime now);

  DeskOptions options_;
  using Heard = std::map<Address, outlet::SteadyTime>;

  Heard heard_;   ///< Clients, and when something came of them last.
  Heard knocks_;  ///< Who asked for frames once, and when; tidied once in a while.
  outlet::SteadyTime tidied_{};
  std::shared_ptr<const Bytes> frame_;
  std::deque<Timestamp> instants_;  ///< Of the newest frames.
  outlet::TokenBucket allowance_;
};

}  // namespace chorus::natnet
