// What the store and the slower subjects hold, as JSON: who a cell is and where it stands, which
// cell answers for a person, and what happened.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "fusion-server/site/cell_people.h"
#include "fusion-server/site/claim.h"
#include "fusion-server/site/site.h"

namespace chorus::nats {

inline constexpr std::size_t kMostRecordBytes = 4096;

/// Bucket chorus_cells, key CELL; and chorus.SITE.CELL.status once a second.
///   {"cell": "a", "boot": 7, "url": "http://10.0.0.5:8080/", "software": "0.5.0",
///    "place": {"x": .., "y": .., "z": .., "qx": .., "qy": .., "qz": .., "qw": ..,
///              "covariance": [36], "clockAddedMs": .., "clockSigmaMs": .., "version": 3}}
struct CellCard {
  site::CellId cell;
  std::uint64_t boot = 0;
  std::string url;       ///< Where it answers; empty: it does not say.
  std::string software;  ///< Its version of Chorus.
  std::optional<site::CellPlace> place;
};
[[nodiscard]] std::string write_card(const CellCard& card);
/// Malformed if a number is missing or too large, or the rotation is none.
[[nodiscard]] Result<CellCard> read_card(std::string_view bytes);

/// Bucket chorus_people, key person.SITEID: {"cell": "a", "state": "held", "sameAs": ".."}
[[nodiscard]] std::string write_claim(const site::Claim& claim);
[[nodiscard]] Result<site::Claim> read_claim(std::string_view key, std::string_view value,
                                             std::uint64_t revision);

/// chorus.SITE.CELL.events: {"event": "Recognised", "at": "..", "siteId": "..", "other": "..",
/// "cell": ".."}; what is empty is left out.
[[nodiscard]] std::string write_event(const site::SiteEvent& event);
[[nodiscard]] std::string_view name_of(site::SiteEventKind kind);
/// The same subject: {"event": "SameAs", "siteId": "..", "other": ".."}: `other` is not used any
/// more.
[[nodiscard]] std::string write_same_as(const site::SameAs& joined);
/// None: it is another event, or none at all.
[[nodiscard]] std::optional<site::SameAs> read_same_as(std::string_view bytes);

/// The file of `site.places`: {"cells": {"a": {"x": ..}, ..}}; keys as in "place" above, of which
/// x, y, z and the quaternion must be there.
[[nodiscard]] Result<std::vector<site::CellPlace>> read_places(std::string_view text);
[[nodiscard]] std::string write_places(const std::vector<site::CellPlace>& places);

}  // namespace chorus::nats
