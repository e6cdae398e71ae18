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

/// A sensor's frame with times by the recorder's clock, or a fused frame, or a registration as
/// JSON, or an instant or a calibration of an inertial source.
using SessionItem = std::variant<SensorFrame, resource::FrameResource, std::string,
                                 inertial::InertialFrame, inertial::InertialCalibration>;

/// Needs memory for only a few chunks, however long the recording is.
class CellStream {
 public:
  /// `files`: as for read_cell(); at first only their first times are read, and each file is opened
  /// when it is needed.
  explicit CellStream(std::vector<std::filesystem::path> files, CellQuery query = {});
  CellStream(CellStream&&) noexcept;
  CellStream& operator=(CellStream&&) noexcept;
  ~CellStream();

  /// The next item; none at the end.  Items come in log order, but late frames at their place, so a
  /// sensor's frames are in order of capture.  Returns the same errors as read_cell(), when it
  /// meets them.
  [[nodiscard]] Result<std::optional<SessionItem>> next();

  /// Call this after the end: returns everything in the recording except the items.
  [[nodiscard]] CellRecording finish();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Limits that make a reader read only what the query needs.
[[nodiscard]] ReadLimits limits_of(const CellQuery& query);

}  // namespace chorus::record
