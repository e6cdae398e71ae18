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

  /// Whether the files hold what worn inertial sensors said.
  [[nodiscard]] bool holds_suits() const;
  /// Reads what inertial sensors said from these recordings, too, with `later` added to their
  /// times. Refuses one that holds nothing of the kind.
  [[nodiscard]] Result<void> wear(const std::vector<std::filesystem::path>& files, Duration later);

  /// Reads from the beginning, also what worn inertial sensors said (OfflineConfig::worn decides
  /// whether that is used).  Of several imports, only the first one's clock counts; the clocks
  /// of the others are unknown, and those of all imports beside what was recorded.
  [[nodiscard]] pipeline::OfflineInput input();

  /// What is known once the newest input has been read to its end: the parts that were left out,
  /// one line each, and the number of sensors.
  struct Told {
    std::vector<std::string> notes;
    std::size_t sensors = 0;
    std::vector<WornReport> worn;  ///< Of the inertial sources that were used.
  };
  [[nodiscard]] Told told();

 private:
  explicit RecordedCell(std::vector<record::CellLine> lines);

  [[nodiscard]] std::vector<pipeline::InertialLane> suits() const;

  std::vector<record::CellLine> lines_;
  std::vector<record::CellLine> suits_;  ///< Beside the lines.
  Duration later_{0};                    ///< Added to the times of suits_.
  std::vector<bool> claims_time_;        ///< Of each line: whether its frames' clock_sigma counts.
  bool clocks_dropped_ = false;
  std::vector<std::shared_ptr<record::CellStream>> streams_;
  std::shared_ptr<std::vector<WornReport>> worn_ = std::make_shared<std::vector<WornReport>>();
};

}  // namespace chorus::ctl
