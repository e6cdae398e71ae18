// Takes pictures from the source while it delivers any; when it delivers none, opens it again.
// Only the newest picture waits: a consumer slower than the camera misses pictures, but never falls
// behind.
#pragma once

#include <optional>
#include <stop_token>

#include "common/base/handover.h"
#include "common/time/clock.h"
#include "services/sensor/device/camera/camera_state.h"
#include "services/sensor/device/camera/capture_clock.h"
#include "services/sensor/device/camera/video.h"

namespace chorus::camera {

struct Shot {
  Picture picture;
  Timestamp captured;  ///< Capture time, by this host's clock.
};

class Grabber {
 public:
  /// Keeps references to its arguments.
  Grabber(const CameraSettings& settings, const Clock& clock, CameraState& state,
          Handover<Shot>& newest);

  /// Runs until stopped, or to the end of a file that does not loop; closes `newest` at the end.
  void run(const std::stop_token& stop);

 private:
  /// Takes pictures from an open source. True at the end of a file, and when a looping file has
  /// fallen so far behind that it must be opened again.
  [[nodiscard]] Result<bool> play(Video& video, const std::stop_token& stop);
  void begin_file(Video& video);
  [[nodiscard]] bool is_over(const VideoMoment& taken) const;
  [[nodiscard]] Timestamp captured(const VideoMoment& taken);
  [[nodiscard]] bool is_wanted(Timestamp captured) const;
  void wait_for(Timestamp due, const std::stop_token& stop);

  const CameraSettings& settings_;
  const Clock& clock_;
  CameraState& state_;
  Handover<Shot>& newest_;
  SourceKind kind_;
  StreamClock stream_;
  FilePace pace_;
  std::optional<Timestamp> given_;  ///< Capture time of the last picture passed on.
  Duration late_{0};                ///< Delay of the last picture of a file.
  Duration over_{0};                ///< Position in the file that was due when the file was opened.
};

/// Sleeps for `pause`; returns false if stopped before its end.
bool rest(const std::stop_token& stop, Duration pause);

}  // namespace chorus::camera
