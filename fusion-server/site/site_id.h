// The id of a person within a site: the same in every cell that sees the person, and never used
// again.
//
// It begins with the time at which it was given, in characters that sort as the times do.  So of
// two ids the smaller one is the older one, for every cell alike.
#pragma once

#include <compare>
#include <cstdint>
#include <string>
#include <string_view>

#include "common/base/result.h"
#include "common/base/strong_id.h"
#include "common/time/timestamp.h"

namespace chorus::site {

/// Names a cell: the same characters as a sensor's name.
using CellId = SensorId;

class SiteId {
 public:
  SiteId() = default;  ///< None: an empty text.
  /// 1-64 characters of [A-Za-z0-9_-], safe in a URI, in a subject and as a key.
  [[nodiscard]] static Result<SiteId> parse(std::string_view text);
  [[nodiscard]] const std::string& str() const noexcept { return text_; }
  [[nodiscard]] bool empty() const noexcept { return text_.empty(); }
  /// In the order of age, the oldest first.
  auto operator<=>(const SiteId&) const = default;

 private:
  explicit SiteId(std::string text) : text_(std::move(text)) {}
  std::string text_;
};

/// Gives ids.  `boot` differs each time the cell starts, so that a cell that has forgotten
/// everything gives no id twice.
class SiteIdSource {
 public:
  SiteIdSource(const CellId& cell, std::uint64_t boot);
  /// "MS-ORIGIN-COUNT" in base 36; MS are nine characters: milliseconds since the Unix epoch.
  [[nodiscard]] SiteId next(Timestamp now);

 private:
  std::string origin_;  ///< Six characters made of the cell's name and the boot.
  std::uint64_t count_ = 0;
};

}  // namespace chorus::site
