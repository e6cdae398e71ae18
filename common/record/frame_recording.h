// Recordings of one sensor: its frames on topic /frame as the JSON of common/resource.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/record/recording.h"
#include "common/sensor/camera_image.h"
#include "common/sensor/sensor_frame.h"

namespace chorus::record {

/// One sensor's part of a recording, in capture order.
struct FrameRecording {
  SensorId sensor;
  std::string device;  ///< "Kinect v2 (LabanotationSuite csv)", "MediaPipe Pose", ...
  std::optional<Intrinsics> intrinsics;
  std::optional<FloorPlane> floor;
  /// Origin, licence, conversions applied; "damage.1", ...: parts that were lost.
  std::map<std::string, std::string> notes;
  std::vector<SensorFrame> frames;
};

/// Writes a recording; replaces `path` only after the whole file has been written.  Malformed if
/// the frames go back in time or repeat a capture time.  A frame without a floor plane is read back
/// with that of the frame before it, the first one with `recording.floor`.
[[nodiscard]] Result<void> write_frame_recording(const std::filesystem::path& path,
                                                 const FrameRecording& recording);

/// Reads one sensor of a recording (a file, or a folder of files): `which`, or the only sensor if
/// `which` is empty or the recording is not that of a cell.  Refuses frames that go back in time or
/// repeat a capture time, unless a recorded clock model corrects their times; the error says where.
[[nodiscard]] Result<FrameRecording> read_frame_recording(const std::filesystem::path& path,
                                                          const ReadLimits& limits = {},
                                                          const SensorId& which = {});

/// The content of such a recording's metadata record "chorus".
[[nodiscard]] std::map<std::string, std::string> metadata_of(const FrameRecording& recording);
void read_metadata(const std::map<std::string, std::string>& values, FrameRecording& out);

}  // namespace chorus::record
