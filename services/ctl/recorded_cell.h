// Recordings as the input of offline fusion: read as often as needed, never held whole.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/record/cell_outline.h"
#include "common/record/cell_stream.h"
#include "fusion-server/pipeline/offline.h"

namespace chorus::ctl {

class RecordedCell {
 public:
  /// Looks at the files without reading them through; errors name the file.
  [[nodiscard]] static Result<RecordedCell> open(const std::vector<std::filesystem::path>& files);

  /// The last registration that was recorded.
  [[nodiscard]] Result<std::optional<Registration>> registration() const;

  /// Starts from the beginning.
  [[nodiscard]] pipeline::OfflineInput input();

  /// What had to be left out when the newest input was read to its end, one line each; and how many
  /// sensors it had.
  struct Told {
    std::vector<std::string> notes;
    std::size_t sensors = 0;
  };
  [[nodiscard]] Told told();

 private:
  explicit RecordedCell(std::vector<record::CellLine> lines) : lines_(std::move(lines)) {}

  std::vector<record::CellLine> lines_;
  std::vector<std::shared_ptr<record::CellStream>> streams_;
};

}  // namespace chorus::ctl
