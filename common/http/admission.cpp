#include "common/http/admission.h"

#include <algorithm>

#include "common/base/descriptor_limit.h"
#include "common/base/log.h"
#include "common/http/http_connection.h"
#include "common/http/server_core.h"
#include "common/http/text.h"
#include "common/net/address.h"

namespace chorus::http {
namespace {

// Connections accepted beyond the limit.  They may read vital paths and get 503 for all others.
constexpr std::size_t kReserve = 32;
constexpr std::size_t kReservePerAddress = 4;
// Descriptors for everything besides HTTP clients: polled sensors, tracker outputs, files, the log.
constexpr std::size_t kDescriptorsOfOthers = 192;

}  // namespace

std::optional<std::string> forwarded_account(const RequestHead& head) {
  const auto field = std::find_if(head.fields.rbegin(), head.fields.rend(), [](const Field& f) {
    return equal_ignoring_case(f.name, "x-forwarded-for");
  });
  if (field == head.fields.rend()) return std::nullopt;
  std::string_view list = field->value;
  std::string_view last;
  while (!list.empty()) last = next_element(list, ',');
  net::error_code failed;
  const auto address = asio::ip::make_address(std::string(last), failed);
  if (failed) return std::nullopt;
  return net::account_of(address);
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

bool ServerCore::is_proxy(const asio::ip::address& address) const {
  const std::string text = net::unmapped(address).to_string();
  const auto& proxies = config.trusted_proxies;
  return std::find(proxies.begin(), proxies.end(), text) != proxies.end();
}

void ServerCore::welcome(net::Socket socket) {
  net::error_code gone;
  const net::tcp::endpoint remote = socket.remote_endpoint(gone);
  const std::string account = net::account_of(remote.address());
  const bool limited =
      !net::unmapped(remote.address()).is_loopback() && !is_proxy(remote.address());
  const std::size_t most_of_it = limited ? config.limits.max_per_address : connections.max_size();
  std::size_t& of_it = per_peer[account];
  if (gone || connections.size() >= most_connections + kReserve ||
      (limited && of_it >= most_of_it + kReservePerAddress)) {
    if (of_it == 0) per_peer.erase(account);
    return;  // Destroying the socket closes it.
  }
  ++of_it;
  const bool surplus_of_it = of_it > most_of_it;
  auto connection = std::make_shared<HttpConnection>(*this, std::move(socket), remote);
  connections.emplace(connection.get(), connection);
  count(counters.connections_total);
  counters.connections_open.store(connections.size(), std::memory_order_relaxed);
  const bool surplus = connections.size() > most_connections;
  if ((!surplus && !surplus_of_it) || close_an_idle_one(connection.get(), surplus_of_it))
    return connection->start();
  count(counters.refused);
  connection->start_in_reserve();
}

/// Closes one idle connection.  With `of_its_address` it is one of the newcomer's address,
/// otherwise one of the address with the most connections.  Among those, it closes the one that has
/// been idle longest.  False if none is idle.
bool ServerCore::close_an_idle_one(const Connection* newcomer, bool of_its_address) {
  std::shared_ptr<Connection> least;
  std::size_t most = 0;
  for (const auto& [key, connection] : connections) {
    if (key == newcomer || !connection->idle()) continue;
    const bool same = connection->peer_address() == newcomer->peer_address();
    if (of_its_address && !same) continue;
    const std::size_t of_address = per_peer[connection->peer_address()];
    const bool longer = least && of_address == most && connection->deadline() < least->deadline();
    if (least && of_address <= most && !longer) continue;
    least = connection;
    most = of_address;
  }
  if (!least) return false;
  count(counters.closed_for_room);
  least->close();
  return true;
}

bool ServerCore::charge(Connection& connection, const std::string& account) {
  if (connection.peer_address() == account) return true;
  std::size_t& of_it = per_peer[account];
  if (of_it >= config.limits.max_per_address) return false;
  ++of_it;
  const auto before = per_peer.find(connection.peer_address());
  if (before != per_peer.end() && --before->second == 0) per_peer.erase(before);
  connection.charge_to(account);
  return true;
}

}  // namespace chorus::http
