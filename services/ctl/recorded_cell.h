// Recordings as the input of offline fusion: read as often as needed, never held whole.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/record/session_outline.h"
#include "common/record/session_stream.h"
#include "fusion-server/pipeline/offline.h"

namespace chorus::ctl {

class RecordedCell {
 public:
  /// Looks at the files without reading them through; their errors say which file.
  [[nodiscard]] static Result<RecordedCell> open(const std::vector<std::filesystem::path>& files);

  /// The last registration that was recorded.
  [[nodiscard]] Result<std::optional<Registration>> registration() const;

  /// From the beginning.
  [[nodiscard]] pipeline::OfflineInput input();

  /// What reading the newest input to its end left out, a line each; and how many sensors it had.
  struct Told {
    std::vector<std::string> notes;
    std::size_t sensors = 0;
  };
  [[nodiscard]] Told told();

 private:
  explicit RecordedCell(std::vector<record::SessionLine> lines) : lines_(std::move(lines)) {}

  std::vector<record::SessionLine> lines_;
  std::vector<std::shared_ptr<record::SessionStream>> streams_;
};

}  // namespace chorus::ctl
