// chorus.SITE.CELL.people: what a cell tells its neighbours thirty times a second, as JSON.
//
//   {"version": 1, "cell": "a", "boot": 7, "sequence": 12, "at": "1795246200000000000",
//    "people": [{"id": 3, "siteId": "...", "siteCertainty": 0.97, "since": "...", "named": "...",
//                "place": [x, y, z], "velocity": [x, y, z], "covariance": [xx, xy, xz, yy, yz, zz],
//                "joints": {"Head": [x, y, z], ...}, "lengths": [[ln m, variance] or null, ...],
//                "sides": 0.99, "carriedFor": 0.2}]}
//
// Metres and seconds, in the world of the cell; times are nanoseconds by the cell's clock.
#pragma once

#include <string>
#include <string_view>

#include "common/base/result.h"
#include "fusion-server/site/cell_people.h"

namespace chorus::nats {

/// More is refused unread.
inline constexpr std::size_t kMostPeopleBytes = 256 * 1024;
inline constexpr std::size_t kMostPeople = 64;

/// Positions to a hundredth of a millimetre.  People beyond kMostPeople are left out.
[[nodiscard]] std::string write_people(const site::CellPeople& people);

/// Reads such a message.  TooLarge or Malformed for anything else: a number that is missing, not
/// finite or above a million, two people of one id, more than kMostPeople, an unknown joint, a
/// covariance that is none.  Keys that are not known are left alone.
[[nodiscard]] Result<site::CellPeople> read_people(std::string_view bytes);

}  // namespace chorus::nats
