// Reads a recording of a cell, or of one sensor, frame by frame (cell_writer.h).
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

/// Needs memory for only a few chunks, however long the recording is.
class CellStream {
 public:
  /// `files` as for read_cell(); each is opened when it is needed.
  explicit CellStream(std::vector<std::filesystem::path> files, CellQuery query = {});
  CellStream(CellStream&&) noexcept;
  CellStream& operator=(CellStream&&) noexcept;
  ~CellStream();

  /// The next item in log order; none at the end.  Returns the errors of read_cell() as they occur.
  [[nodiscard]] Result<std::optional<SessionItem>> next();

  /// To be called after the end: everything in the recording except the items.
  [[nodiscard]] CellRecording finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The part of a recording that such a query has to read.
[[nodiscard]] ReadLimits limits_of(const CellQuery& query);

}  // namespace chorus::record
