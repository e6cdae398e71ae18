// The subjects and keys that the cells of a site use: chorus.SITE.CELL.KIND (proto/README.md).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fusion-server/site/site_id.h"

namespace chorus::nats {

inline constexpr std::string_view kPeople = "people";
inline constexpr std::string_view kFrame = "frame";
inline constexpr std::string_view kEvents = "events";
inline constexpr std::string_view kStatus = "status";
inline constexpr std::string_view kRegistration = "registration";
/// A request: an instant; the answer is the cell's frame of that instant.
inline constexpr std::string_view kAskFrame = "ask.frame";
/// Asks the cell to publish its frames for the next few seconds; nothing is answered.
inline constexpr std::string_view kWantFrames = "ask.frames";

/// Buckets of the store: which cells there are, and which cell answers for whom.
inline constexpr const char* kCellsBucket = "chorus_cells";
inline constexpr const char* kPeopleBucket = "chorus_people";

/// "chorus.hall.a.people"; the cell may be "*".
[[nodiscard]] inline std::string subject_of(std::string_view site, std::string_view cell,
                                            std::string_view kind) {
  std::string subject = "chorus.";
  return subject.append(site).append(".").append(cell).append(".").append(kind);
}

/// The cell of such a subject; none if it is not one of this site.
[[nodiscard]] inline std::optional<site::CellId> cell_of(std::string_view subject,
                                                         std::string_view site) {
  const std::string start = "chorus." + std::string(site) + ".";
  if (!subject.starts_with(start)) return std::nullopt;
  subject.remove_prefix(start.size());
  auto cell = site::CellId::parse(subject.substr(0, subject.find('.')));
  if (!cell) return std::nullopt;
  return std::move(*cell);
}

/// "person.SITEID"
[[nodiscard]] inline std::string claim_key(const site::SiteId& id) { return "person." + id.str(); }

}  // namespace chorus::nats
