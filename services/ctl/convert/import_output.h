// Writes imported recordings, and what belongs to them, into a folder.
#pragma once

#include <filesystem>
#include <vector>

#include "common/importers/formats.h"

namespace chorus::ctl {

/// Writes one recording for each sensor, registration.json and truth.ndjson if there are any, and
/// returns the files.  Refuses to replace a recording that was recorded, and a registration that
/// places other sensors.
[[nodiscard]] Result<std::vector<std::filesystem::path>> write_set(
    const std::filesystem::path& folder, const importers::ImportedSet& set);

/// Makes the folder of a recording that is to be written, and removes an earlier import of that
/// name.  Refuses where that file was recorded, not imported.
[[nodiscard]] Result<void> make_room_for(const std::filesystem::path& file);

/// Warns of other recordings in the folder, because they would be fused along with this import.
void warn_of_strangers(const std::filesystem::path& folder,
                       const std::vector<std::filesystem::path>& written);

}  // namespace chorus::ctl
