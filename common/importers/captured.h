// Reads motion files (common/motion): one motion per person.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "common/importers/file_space.h"
#include "common/importers/import_options.h"
#include "common/motion/motion.h"

namespace chorus::importers {

enum class MotionFormat { C3d, Trc, Bvh, Htr, Mvnx };

/// What every reader returns; all persons have the same number of frames.
struct Captured {
  std::string device;
  std::vector<motion::Motion> persons;
  std::vector<std::uint64_t> ids;  ///< Ids of the persons.
  std::map<std::string, std::string> notes = {};
  std::vector<std::string> damage = {};  ///< What was salvaged or is contradictory.
  FileSpace space = {};
};

/// The file in our axes and metres, with options.metres_per_unit, up and joints.
[[nodiscard]] Result<Captured> read_captured(const std::filesystem::path& file, MotionFormat format,
                                             const ImportOptions& options);

/// The text of a file for --joints: the names in this file, and which joints were found.
[[nodiscard]] Result<std::string> joint_template(const std::filesystem::path& file,
                                                 MotionFormat format);

}  // namespace chorus::importers
