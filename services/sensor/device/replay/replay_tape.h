// What the device `replay` plays: a recording of one sensor, frame by frame, repeatedly.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "common/base/result.h"
#include "common/record/frame_recording.h"

namespace chorus::sensor_service {

/// When the frames of a tape were captured.
struct TapeSpan {
  Timestamp first;
  Timestamp last;
  std::uint64_t frames = 0;  ///< Number of frames, at least one; playing may leave out some.
  Duration step{0};          ///< The usual time between two frames.
};

class ReplayTape {
 public:
  virtual ~ReplayTape() = default;

  /// Everything in the recording except the frames.
  [[nodiscard]] virtual const record::FrameRecording& about() const = 0;
  [[nodiscard]] virtual TapeSpan span() const = 0;
  /// The next frame, with strictly rising capture times; none at the end.
  [[nodiscard]] virtual Result<std::optional<SensorFrame>> next() = 0;
  virtual void rewind() = 0;
};

/// A tape in memory.
[[nodiscard]] Result<std::unique_ptr<ReplayTape>> tape_of(record::FrameRecording recording);

/// A tape from a file or a folder of files; it is read while it plays, so opening it is quick.
/// `which` selects one of several sensors; a recording of one sensor may be played under any name.
[[nodiscard]] Result<std::unique_ptr<ReplayTape>> open_tape(const std::filesystem::path& path,
                                                            const SensorId& which);

}  // namespace chorus::sensor_service
