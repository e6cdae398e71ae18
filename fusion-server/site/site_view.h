// What a site looks like from one of its cells, for whoever shows it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fusion-server/flow/snapshot.h"
#include "fusion-server/site/site.h"

namespace chorus::site {

/// What is known of a cell: from the core, and from what it says of itself.
struct KnownCell {
  CellState state;
  std::string url;       ///< Where it answers; empty: it does not say.
  std::string software;  ///< Its version of Chorus.
  std::optional<CellPlace> place;
};

/// Our connection to the other cells.
struct SiteConnection {
  bool connected = false;
  std::string server;
  std::string trouble;  ///< Why it is not connected, or what the server complained of.
  std::uint64_t published = 0;
  std::uint64_t dropped = 0;  ///< What could not be sent, or nobody had time to read.
  std::uint64_t refused = 0;  ///< Messages of others that could not be used.
  std::string last_refusal;
};

/// After a message of our own cell, or of others.
struct SiteView {
  std::string site;
  CellId own;
  Timestamp at;                              ///< By our clock.
  std::vector<SitePerson> people;            ///< Everybody, in the order of their ids.
  std::vector<Named> ours;                   ///< The people of our own cell and their ids.
  std::vector<KnownCell> cells;              ///< With our own, in the order of their names.
  std::vector<SiteEvent> events;             ///< The newest fifty.
  std::shared_ptr<const Snapshot> snapshot;  ///< Everybody: nats/site_snapshot.h.
  /// What outputs show of the site: `snapshot`; while our cell has no place in the site, so that
  /// nobody of it is in there, its own newest snapshot.  Null: not made for a message of our own,
  /// and outputs keep to the pace of our cell.
  std::shared_ptr<const Snapshot> shown;
  SiteConnection connection;
};

}  // namespace chorus::site
