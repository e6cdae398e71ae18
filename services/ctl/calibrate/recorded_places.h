// Where the sensors of recordings stand: from a file, from the recording, from beside it, or from
// the person who walks in it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fusion-server/pipeline/offline.h"
#include "services/ctl/record/recorded_cell.h"

namespace CLI {
class App;
}

namespace chorus::ctl {

struct PlaceOptions {
  std::string registration;  ///< --registration; empty: none.
  bool from_walk = false;
};

void add_place_options(CLI::App& app, PlaceOptions& options);

/// Extrinsics, and a remark for the user on where they are from.
struct Places {
  std::optional<Registration> registration;  ///< None: nothing gives them.
  std::string note;
  bool solved = false;  ///< They were solved from the walk.
};

/// The extrinsics from a file, from the recording, or from beside it; none if nothing gives them.
[[nodiscard]] Result<Places> given_places(const PlaceOptions& options,
                                          const std::vector<std::filesystem::path>& files,
                                          const RecordedCell& cell);

/// The extrinsics as the options say; solves them from the walk where nothing gives them.
[[nodiscard]] Result<Places> places_of(const PlaceOptions& options,
                                       const std::vector<std::filesystem::path>& files,
                                       RecordedCell& cell, const pipeline::OfflineConfig& config);

}  // namespace chorus::ctl
