// Turns files of inertial sensors into a recording of /inertial/{id}/orientations.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/base/strong_id.h"
#include "common/inertial/inertial_frame.h"
#include "common/time/timestamp.h"

namespace chorus::ctl {

/// The format of `chorus import`: sensors that people wear, which have no skeletons.
inline constexpr std::string_view kInertialFormat = "inertial";
inline constexpr std::string_view kInertialReads =
    "logs of worn sensors (MT Manager .txt, Movella DOT .csv, OpenSim .sto, .mvnx), as one suit";

struct InertialImport {
  /// What the source is called, and the recording's file.
  SensorId source = SensorId::parse("suit").value();
  /// Of the first instant; none: as the files say, or ImportOptions::start where they state no
  /// date.
  std::optional<Timestamp> start;
};

struct ImportedSuit {
  std::filesystem::path file;
  SensorId source;
  std::vector<inertial::InertialFrame> instants;
  std::vector<std::string> sensors;
  std::vector<std::string> notes;  ///< For people, each with the sensor's name.
};

/// Reads all files as one take (inertial_files.h) and writes FOLDER/SOURCE.mcap; the same files
/// give the same bytes.  Refuses to replace a recording that was not imported.
[[nodiscard]] Result<ImportedSuit> import_inertial(const std::vector<std::string>& files,
                                                   const std::filesystem::path& folder,
                                                   const InertialImport& how);

/// What was imported, on standard output; notes on standard error.
void print_imported(const ImportedSuit& suit, bool json);

}  // namespace chorus::ctl
