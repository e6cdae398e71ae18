// Recordings as the input of offline fusion: read as often as needed, never entirely in memory.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/record/cell_outline.h"
#include "common/record/cell_stream.h"
#include "fusion-server/pipeline/offline.h"

namespace chorus::ctl {

/// The `registration.json` in the folder of the recordings; none if there is none.  Conflict when
/// several of their folders have one.
[[nodiscard]] Result<std::optional<std::filesystem::path>> registration_beside(
    const std::vector<std::filesystem::path>& files);

class RecordedCell {
 public:
  /// Looks at the files without reading all of them; errors name the file.
  [[nodiscard]] static Result<RecordedCell> open(const std::vector<std::filesystem::path>& files);

  /// The sensors that the files name.
  [[nodiscard]] std::set<SensorId> sensors() const;

  /// The last registration that was recorded.
  [[nodiscard]] Result<std::optional<Registration>> registration() const;

  /// From now on, frames are read as those of unknown clocks: a walk showed that they are not in
  /// step as stated.
  void drop_clock_claims() { clocks_dropped_ = true; }

  /// Reads from the beginning.  Of several imports, only the first one's clock counts; the clocks
  /// of the others are unknown, and those of all imports beside what was recorded.
  [[nodiscard]] pipeline::OfflineInput input();

  /// What is known once the newest input has been read to its end: the parts that were left out,
  /// one line each, and the number of sensors.
  struct Told {
    std::vector<std::string> notes;
    std::size_t sensors = 0;
  };
  [[nodiscard]] Told told();

 private:
  explicit RecordedCell(std::vector<record::CellLine> lines);

  std::vector<record::CellLine> lines_;
  std::vector<bool> claims_time_;  ///< Of each line: whether its frames' clock_sigma counts.
  bool clocks_dropped_ = false;
  std::vector<std::shared_ptr<record::CellStream>> streams_;
};

}  // namespace chorus::ctl
