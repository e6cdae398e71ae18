// How many clients a server accepts, in total and from one address.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/base/duration.h"

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

/// A client that a server has, as far as it matters when another one arrives.
struct Occupant {
  std::string_view address;
  bool greeted = false;  ///< It has said what a client of the protocol says first.
  SteadyTime heard{};    ///< When it last said anything; when it connected, if it never did.
  bool stays = false;    ///< It is at work although it says nothing.
};

/// The client that makes room for a newcomer, so that idle connections do not lock anybody out: of
/// the newcomer's address, when that has as many as it may have, otherwise of the address with the
/// most. First those that have not greeted, then those that have been silent for kIdle; of these
/// the one that was silent longest.  None while there is room, and when nobody is idle.
[[nodiscard]] std::optional<std::size_t> who_makes_room(const Capacity& capacity,
                                                        std::span<const Occupant> all,
                                                        std::string_view newcomer, SteadyTime now);

/// A client that has greeted is idle when it has been silent for so long.
inline constexpr std::chrono::seconds kIdle{10};

}  // namespace chorus::net
