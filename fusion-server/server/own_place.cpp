#include "fusion-server/server/own_place.h"

#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/json.h"
#include "common/base/log.h"
#include "fusion-server/nats/cell_records.h"
#include "fusion-server/site/places.h"

namespace chorus::server {
namespace {

constexpr std::size_t kMostBytes = 1 << 16;

/// Numbers lose their last digits in a file.  The origin of a newly found hall lies where that of
/// the old one lay: only the version tells them apart.
bool same(const site::CellPlace& one, const site::CellPlace& other) {
  constexpr double kExact = 1e-6;
  const auto clock = std::chrono::abs(one.clock_added - other.clock_added) +
                     std::chrono::abs(one.clock_sigma - other.clock_sigma);
  return one.version == other.version &&
         one.site_from_cell.isApprox(other.site_from_cell, kExact) &&
         (one.covariance - other.covariance).cwiseAbs().maxCoeff() < kExact &&
         clock < std::chrono::microseconds(10);
}

std::string text_of(const site::CellPlace& place) { return nats::write_places({place}); }

std::optional<site::CellPlace> place_in(const nlohmann::json& file, const char* key) {
  const auto part = file.is_object() ? file.find(key) : file.end();
  if (part == file.end()) return std::nullopt;
  const auto places = nats::read_places(part->dump());
  if (!places || places->size() != 1) return std::nullopt;
  return places->front();
}

void write(const std::string& file, const std::string& text) {
  if (const auto done = replace_file(file, text); !done)
    log::warn("where the cell was moved to is not kept", {{"reason", to_string(done.error())}});
}

void forget(const std::filesystem::path& file) {
  std::error_code failed;
  std::filesystem::remove(file, failed);
  if (failed)
    log::warn("where the cell was moved to is not forgotten: remove the file",
              {{"file", file.string()}, {"reason", failed.message()}});
  sync_folder(file.parent_path());
}

}  // namespace

OwnPlace::OwnPlace(const std::string& folder)
    : file_(folder.empty() ? "" : folder + "/site-place.json") {
  load();
}

void OwnPlace::load() {
  kept_ = !file_.empty() && is_there(file_);
  if (!kept_) return;
  const auto text = read_file(file_, kMostBytes);
  const auto json = text ? parse_json(*text) : Result<nlohmann::json>(pass(text));
  if (json) {
    typed_ = place_in(*json, "typed");
    now_ = place_in(*json, "now");
  }
  if (!typed_ || !now_)
    log::warn("where the cell was moved to cannot be read: the file of places counts",
              {{"file", file_}});
}

std::optional<site::CellPlace> OwnPlace::typed(const std::optional<site::CellPlace>& place) {
  if (!place || !typed_ || !now_ || !same(*place, *typed_)) {
    now_ = place;
    if (std::exchange(kept_, false)) worker_.post([file = file_] { forget(file); });
  }
  typed_ = place;
  return now_;
}

std::optional<site::CellPlace> OwnPlace::moved(const Eigen::Isometry3d& new_from_old) {
  if (!now_ || !typed_) return std::nullopt;
  now_ = site::after_move(*now_, new_from_old);
  if (!file_.empty()) {
    kept_ = true;
    worker_.post(
        [file = file_, text = fmt::format("{{\"typed\": {},\n\"now\": {}}}\n", text_of(*typed_),
                                          text_of(*now_))] { write(file, text); });
  }
  return now_;
}

}  // namespace chorus::server
