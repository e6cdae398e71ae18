// A recording of a cell, or of one sensor, read frame by frame (cell_writer.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/record/cell_reader.h"

namespace chorus::record {

/// A sensor's frame by the recorder's clock, a fused frame, or a registration as JSON.
using SessionItem = std::variant<SensorFrame, resource::FrameResource, std::string>;

/// Needs the memory of a few chunks, however long the recording is.
class CellStream {
 public:
  /// `files`: as read_cell() takes them; each is opened when its turn comes.
  explicit CellStream(std::vector<std::filesystem::path> files, CellQuery query = {});
  CellStream(CellStream&&) noexcept;
  CellStream& operator=(CellStream&&) noexcept;
  ~CellStream();

  /// The next item in log order; none at the end.  The errors of read_cell(), where they occur.
  [[nodiscard]] Result<std::optional<SessionItem>> next();

  /// After the end: what the recording holds beside the items.
  [[nodiscard]] CellRecording finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What has to be read of a recording for such a query.
[[nodiscard]] ReadLimits limits_of(const CellQuery& query);

}  // namespace chorus::record
