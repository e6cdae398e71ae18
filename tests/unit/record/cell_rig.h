// A recording of a cell of two sensors, for tests of its readers.
#pragma once

#include <gtest/gtest.h>

#include "common/record/cell_writer.h"
#include "tests/support/builders.h"

namespace chorus::record {

inline constexpr int kCellFrames = 40;  ///< Number of frames of each sensor, and of fused ones.

/// A frame as the recorder receives it: 5 ms after its capture by the recorder's clock.  The
/// sensor's clock is behind the recorder's by `applied`.
inline RawFrame raw_frame(const char* sensor, std::shared_ptr<const resource::FrameResource> frame,
                          Duration applied = Duration{0}) {
  const Timestamp received = frame->captured + applied + std::chrono::milliseconds(5);
  return {chorus::testing::sensor_id(sensor), std::move(frame), received,
          FloorPlane{Eigen::Vector3d::UnitY(), 1.25},
          ClockModel{applied, applied, std::chrono::milliseconds(1)}};
}

/// Sensors s1 and s2 and their fused frames; the correction of s2's clock changes half-way, from
/// 400 to 410 ms.  `seen_by` (sensor, number) makes sensor frames, `fused` (number) fused ones.
template <typename SeenBy, typename Fused>
void write_cell(const std::filesystem::path& path, const PlacesChanged& places,
                const SeenBy& seen_by, const Fused& fused) {
  auto writer = CellWriter::create(path, {});
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->write(places));
  for (int i = 0; i < kCellFrames; ++i) {
    const std::chrono::milliseconds behind(i < kCellFrames / 2 ? 400 : 410);
    ASSERT_TRUE(writer->write(raw_frame("s1", seen_by("s1", i))));
    ASSERT_TRUE(writer->write(raw_frame("s2", seen_by("s2", i), behind)));
    ASSERT_TRUE(writer->write(fused(i)));
  }
  ASSERT_TRUE(writer->close());
}

}  // namespace chorus::record
