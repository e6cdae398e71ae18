#include "common/http/admission.h"

#include <algorithm>
#include <array>

#include "common/base/descriptor_limit.h"
#include "common/base/log.h"
#include "common/http/server_core.h"
#include "common/http/text.h"

namespace chorus::http {
namespace {

// Connections beyond the limit: they are told so, and may read what is vital.
constexpr std::size_t kReserve = 32;
constexpr std::size_t kReservePerAddress = 4;
// Descriptors for everything else: polled sensors, tracker outputs, files, the log.
constexpr std::size_t kDescriptorsOfOthers = 192;

}  // namespace

net::ip::address unmapped(const net::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6());
}

std::string account_of(const net::ip::address& address) {
  const net::ip::address plain = unmapped(address);
  if (plain.is_v4() || plain.is_loopback()) return plain.to_string();
  constexpr std::size_t kNetBytes = 8;
  auto bytes = plain.to_v6().to_bytes();
  std::fill(bytes.begin() + kNetBytes, bytes.end(), std::uint8_t{0});
  return net::ip::make_address_v6(bytes).to_string() + "/64";
}

std::optional<std::string> forwarded_account(const RequestHead& head) {
  const auto field = std::find_if(head.fields.rbegin(), head.fields.rend(), [](const Field& f) {
    return equal_ignoring_case(f.name, "x-forwarded-for");
  });
  if (field == head.fields.rend()) return std::nullopt;
  std::string_view list = field->value;
  std::string_view last;
  while (!list.empty()) last = next_element(list, ',');
  error_code failed;
  const auto address = net::ip::make_address(std::string(last), failed);
  if (failed) return std::nullopt;
  return account_of(address);
}

void ServerCore::fit_descriptors() {
  const std::size_t given = raise_descriptor_limit();
  const std::size_t others = kDescriptorsOfOthers + kReserve + config.limits.max_downloads;
  const std::size_t room = given > 2 * others ? given - others : given / 2;
  most_connections = std::min(config.limits.max_connections, room);
  counters.connections_limit.store(most_connections, std::memory_order_relaxed);
  if (most_connections == config.limits.max_connections) return;
  log::warn("fewer connections than http.max_connections are possible",
            {{"possible", most_connections},
             {"wanted", config.limits.max_connections},
             {"descriptors", given},
             {"advice", "raise the limit of open files (ulimit -Hn, LimitNOFILE)"}});
}

bool ServerCore::is_proxy(const net::ip::address& address) const {
  const std::string text = unmapped(address).to_string();
  const auto& proxies = config.trusted_proxies;
  return std::find(proxies.begin(), proxies.end(), text) != proxies.end();
}

void ServerCore::welcome(Socket socket) {
  error_code gone;
  const tcp::endpoint remote = socket.remote_endpoint(gone);
  const std::string account = account_of(remote.address());
  const bool limited = !unmapped(remote.address()).is_loopback() && !is_proxy(remote.address());
  const std::size_t most_of_it = limited ? config.limits.max_per_address : sessions.max_size();
  std::size_t& of_it = per_peer[account];
  if (gone || sessions.size() >= most_connections + kReserve ||
      (limited && of_it >= most_of_it + kReservePerAddress)) {
    if (of_it == 0) per_peer.erase(account);
    return;  // Closes it.
  }
  ++of_it;
  const bool surplus_of_it = of_it > most_of_it;
  auto connection = std::make_shared<Connection>(*this, std::move(socket), remote);
  sessions.emplace(connection.get(), connection);
  count(counters.connections_total);
  counters.connections_open.store(sessions.size(), std::memory_order_relaxed);
  const bool surplus = sessions.size() > most_connections;
  if ((!surplus && !surplus_of_it) || close_an_idle_one(connection.get(), surplus_of_it))
    return connection->start();
  count(counters.refused);
  connection->start_in_reserve();
}

/// An idle connection gives way: of the newcomer's own address, or of the address that has most of
/// all; of those the one that has been idle longest.
bool ServerCore::close_an_idle_one(const Session* newcomer, bool of_its_address) {
  std::shared_ptr<Session> least;
  std::size_t most = 0;
  for (const auto& [key, session] : sessions) {
    if (key == newcomer || !session->idle()) continue;
    const bool same = session->peer_address() == newcomer->peer_address();
    if (of_its_address && !same) continue;
    const std::size_t of_address = per_peer[session->peer_address()];
    const bool longer = least && of_address == most && session->deadline() < least->deadline();
    if (least && of_address <= most && !longer) continue;
    least = session;
    most = of_address;
  }
  if (!least) return false;
  count(counters.closed_for_room);
  least->close();
  return true;
}

bool ServerCore::charge(Session& session, const std::string& account) {
  if (session.peer_address() == account) return true;
  std::size_t& of_it = per_peer[account];
  if (of_it >= config.limits.max_per_address) return false;
  ++of_it;
  const auto before = per_peer.find(session.peer_address());
  if (before != per_peer.end() && --before->second == 0) per_peer.erase(before);
  session.charge_to(account);
  return true;
}

}  // namespace chorus::http
