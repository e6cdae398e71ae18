// How many clients a server accepts, in total and from one address.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace chorus::net {

struct Capacity {
  std::size_t all = 0;
  std::size_t of_address = 0;       ///< Limit for one address, so that no host can take all places.
  std::string_view all_key;         ///< The key that sets `all`: "outputs.vrpn.max_clients".
  std::string_view of_address_key;  ///< The key that sets `of_address`.
};

/// How many clients a server has when another one arrives.
struct ClientCount {
  std::size_t all = 0;
  std::size_t of_address = 0;  ///< Clients from the newcomer's address.
};

/// Why a client from `address` is refused, and the key to change; empty when there is room.
[[nodiscard]] std::string objection(const Capacity& capacity, const ClientCount& count,
                                    std::string_view address);

}  // namespace chorus::net
