#include "fusion-server/nats/cell_records.h"

#include <array>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "fusion-server/nats/json_fields.h"
#include "fusion-server/nats/subjects.h"
#include "fusion-server/wire/registration_fields.h"

namespace chorus::nats {
namespace {

using nlohmann::json;

constexpr std::size_t kMostText = 512;
constexpr const char* kSameAs = "SameAs";
constexpr std::size_t kMostPlacesBytes = 1 << 20;
constexpr std::size_t kPoseTerms = 36;
/// A quaternion of another length is a mistake of whoever wrote it.
constexpr double kUnitTolerance = 0.01;

constexpr std::array<std::pair<site::ClaimState, std::string_view>, 3> kStates{
    {{site::ClaimState::Held, "held"},
     {site::ClaimState::Released, "released"},
     {site::ClaimState::Joined, "joined"}}};

/// In the order of SiteEventKind.
constexpr std::array<std::string_view, 12> kEventNames{
    "Named",      "Recognised", "Returned", "Renamed",   "Joined",    "TakenOver",
    "HandedOver", "Disputed",   "CellLost", "CellFound", "CellTwice", "CellMistrusted"};

double milliseconds(Duration duration) { return seconds(duration) * 1e3; }

json place_json(const site::CellPlace& place) {
  const Eigen::Vector3d t = place.site_from_cell.translation();
  const Eigen::Quaterniond q(place.site_from_cell.linear());
  json out{{"x", t.x()},
           {"y", t.y()},
           {"z", t.z()},
           {"qx", q.x()},
           {"qy", q.y()},
           {"qz", q.z()},
           {"qw", q.w()},
           {"version", place.version},
           {"clockAddedMs", milliseconds(place.clock_added)},
           {"clockSigmaMs", milliseconds(place.clock_sigma)}};
  if (!place.covariance.isZero()) {
    json all = json::array();
    for (const double term : place.covariance.reshaped()) all.push_back(term);
    out["covariance"] = std::move(all);
  }
  return out;
}

void read_rotation(JsonFields& fields, Eigen::Isometry3d& out) {
  const double w = fields.number("qw");
  const double x = fields.number("qx");
  const double y = fields.number("qy");
  const double z = fields.number("qz");
  const Eigen::Quaterniond q(w, x, y, z);
  if (!(std::abs(q.norm() - 1.0) <= kUnitTolerance))
    return fields.complain("qw", "is of a quaternion whose length is not 1");
  out.linear() = q.normalized().toRotationMatrix();
}

Result<site::CellPlace> read_place(const json& object, const site::CellId& cell) {
  const std::string where = "cells." + cell.str();
  JsonFields fields(object, where);
  site::CellPlace place;
  place.cell = cell;
  read_rotation(fields, place.site_from_cell);
  const double x = fields.number("x");
  const double y = fields.number("y");
  const double z = fields.number("z");
  place.site_from_cell.translation() = Eigen::Vector3d(x, y, z);
  place.clock_added = from_seconds(fields.maybe_number("clockAddedMs").value_or(0.0) * 1e-3);
  place.clock_sigma = from_seconds(fields.maybe_number("clockSigmaMs").value_or(0.0) * 1e-3);
  if (place.clock_sigma < Duration{0}) fields.complain("clockSigmaMs", "must be at least 0");
  if (fields.find("version") != nullptr) place.version = fields.count("version");
  if (const auto terms = fields.maybe_numbers("covariance", kPoseTerms)) {
    place.covariance = Eigen::Map<const Eigen::Matrix<double, 6, 6>>(terms->data());
    if (auto ok = wire::check_covariance(place.covariance, where); !ok) return pass(ok);
  }
  if (fields.error()) return tl::unexpected(*fields.error());
  return place;
}

}  // namespace

std::string write_card(const CellCard& card) {
  json out{{"cell", card.cell.str()}, {"boot", card.boot}, {"software", card.software}};
  if (!card.url.empty()) out["url"] = card.url;
  if (card.place) out["place"] = place_json(*card.place);
  return out.dump(-1, ' ', false, json::error_handler_t::replace);
}

Result<CellCard> read_card(std::string_view bytes) {
  const auto parsed = parse_json(bytes, {kMostRecordBytes, 4});
  if (!parsed) return pass(parsed);
  JsonFields fields(*parsed, "");
  CellCard card;
  card.cell = fields.cell("cell");
  card.boot = fields.count("boot");
  card.url = fields.text("url", kMostText);
  card.software = fields.text("software", kMostText);
  if (fields.error()) return tl::unexpected(*fields.error());
  if (const json* place = fields.find("place")) {
    auto read = read_place(*place, card.cell);
    if (!read) return pass(read);
    card.place = std::move(*read);
  }
  return card;
}

std::string write_claim(const site::Claim& claim) {
  json out{{"cell", claim.cell.str()}};
  for (const auto& [state, name] : kStates)
    if (claim.state == state) out["state"] = name;
  if (claim.same_as) out["sameAs"] = claim.same_as->str();
  return out.dump();
}

Result<site::Claim> read_claim(std::string_view key, std::string_view value,
                               std::uint64_t revision) {
  constexpr std::string_view kStart = "person.";
  const auto id = key.starts_with(kStart) ? site::SiteId::parse(key.substr(kStart.size()))
                                          : site::SiteId::parse("");
  if (!id) return pass(id);
  const auto parsed = parse_json(value, {kMostRecordBytes, 4});
  if (!parsed) return pass(parsed);
  JsonFields fields(*parsed, std::string(key.substr(0, kMostText)));
  site::Claim claim;
  claim.id = *id;
  claim.cell = fields.cell("cell");
  claim.revision = revision;
  claim.same_as = fields.maybe_site_id("sameAs");
  const std::string named = fields.text("state", kMostText);
  bool known = false;
  for (const auto& [state, name] : kStates) {
    if (named != name) continue;
    claim.state = state;
    known = true;
  }
  if (!known) fields.complain("state", "must be held, released or joined");
  if (claim.state == site::ClaimState::Joined && !claim.same_as)
    fields.complain("sameAs", "is missing");
  if (fields.error()) return tl::unexpected(*fields.error());
  return claim;
}

std::string_view name_of(site::SiteEventKind kind) {
  const auto index = static_cast<std::size_t>(kind);
  return index < kEventNames.size() ? kEventNames[index] : std::string_view("Unknown");
}

std::string write_event(const site::SiteEvent& event) {
  json out{{"event", name_of(event.kind)}, {"at", time_text(event.at)}};
  if (!event.id.empty()) out["siteId"] = event.id.str();
  if (!event.other.empty()) out["other"] = event.other.str();
  if (!event.cell.str().empty()) out["cell"] = event.cell.str();
  return out.dump();
}

std::string write_same_as(const site::SameAs& joined) {
  return json{{"event", kSameAs}, {"siteId", joined.kept.str()}, {"other", joined.joined.str()}}
      .dump();
}

std::optional<site::SameAs> read_same_as(std::string_view bytes) {
  const auto parsed = parse_json(bytes, {kMostRecordBytes, 4});
  if (!parsed) return std::nullopt;
  JsonFields fields(*parsed, "");
  if (fields.text("event", kMostText) != kSameAs) return std::nullopt;
  const auto kept = fields.maybe_site_id("siteId");
  const auto joined = fields.maybe_site_id("other");
  if (!kept || !joined) return std::nullopt;
  return site::SameAs{*kept, *joined};
}

Result<std::vector<site::CellPlace>> read_places(std::string_view text) {
  const auto parsed = parse_json(text, {kMostPlacesBytes, 8, true});
  if (!parsed) return pass(parsed);
  const json cells = parsed->is_object() ? parsed->value("cells", json()) : json();
  if (!cells.is_object())
    return fail(ErrorCode::Malformed, "cells",
                R"(is missing: {"cells": {"a": {"x": 0, "y": 0, "z": 0, "qx": 0, "qy": 0, )"
                R"("qz": 0, "qw": 1}}})");
  std::vector<site::CellPlace> places;
  for (const auto& [name, object] : cells.items()) {
    const auto cell = site::CellId::parse(name);
    if (!cell) return pass(cell);
    auto place = read_place(object, *cell);
    if (!place) return pass(place);
    places.push_back(std::move(*place));
  }
  return places;
}

std::string write_places(const std::vector<site::CellPlace>& places) {
  json cells = json::object();
  for (const site::CellPlace& place : places) cells[place.cell.str()] = place_json(place);
  return json{{"cells", std::move(cells)}}.dump(1) + "\n";
}

}  // namespace chorus::nats
