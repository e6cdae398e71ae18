// Which cell answers for a person, and when that changes.
//
// The cell that names a person claims them.  Another cell takes them over when it has stated the
// smaller error for half a second, or when the holder has not seen them for 0.3 s.  All changes are
// compare-and-set (claim.h), so two cells that want the same person cannot both get them.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "fusion-server/site/claim.h"
#include "fusion-server/site/site_config.h"

namespace chorus::site {

/// What a cell states of a person now.
struct StatedBy {
  CellId cell;
  double variance = 0.0;  ///< Mean of both axes on the floor [m^2].
  bool seen = true;       ///< False: carried.
};

/// One of our people who has an id.
struct OwnSight {
  SiteId id;
  double variance = 0.0;
  bool seen = true;
  bool sure = true;              ///< The certainty of the id is not below SiteConfig::doubt.
  std::vector<StatedBy> others;  ///< The other cells that tell of them now and are believed.
};

class Ownership {
 public:
  Ownership(CellId own, const SiteConfig& config) : own_(std::move(own)), config_(config) {}

  void take(const Claim& claim, Timestamp now);
  void take(const ClaimResult& result, Timestamp now);
  /// `joined` is an alias of `kept` from now on; the store is to be told so.
  void join(const SiteId& kept, const SiteId& joined);
  /// What is to be written, given all our people now.
  [[nodiscard]] std::vector<ClaimRequest> wanted(std::span<const OwnSight> people, Timestamp now);
  /// None: nobody has claimed the person.
  [[nodiscard]] std::optional<CellId> holder(const SiteId& id) const;
  /// The cell that answers for one of our people: the holder while it tells of them, else us.
  [[nodiscard]] CellId answers(const OwnSight& person) const;

 private:
  struct Known {
    std::optional<Claim> claim;
    std::optional<Timestamp> better;  ///< Since when our stated error is the smaller one.
    std::optional<Timestamp> absent;  ///< Since when the holder has not seen the person.
    std::optional<Timestamp> asked;
    Timestamp touched;
    Timestamp told;  ///< When we last saw the person, if we did.
  };
  [[nodiscard]] bool wants(Known& known, const OwnSight& person, Timestamp now) const;
  void ask(std::vector<ClaimRequest>& requests, Known& known, const Claim& value, Timestamp now);
  void release_unseen(std::vector<ClaimRequest>& requests, Timestamp now);
  void ask_for_joined(std::vector<ClaimRequest>& requests, Timestamp now);

  CellId own_;
  SiteConfig config_;
  std::map<SiteId, Known> known_;
  std::map<SiteId, SiteId> to_join_;  ///< Joined ids whose record does not say so yet.
};

}  // namespace chorus::site
