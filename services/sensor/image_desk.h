// Camera images, encoded off the server's thread: rendering and packing takes tens of milliseconds,
// and nobody who waits for a frame should have to wait for an image.
//
// While somebody asks, captures are encoded as fast as possible; otherwise one a second, so that
// the first answer is not old.  Switched off, nothing is encoded and nothing is kept.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>

#include "common/base/result.h"
#include "services/sensor/latest_capture.h"

namespace chorus::sensor_service {

using SteadyNow = std::function<std::chrono::steady_clock::time_point()>;

/// Thread-safe.
class ImageDesk {
 public:
  ImageDesk(bool on, SteadyNow steady_now) : steady_now_(std::move(steady_now)), on_(on) {}

  /// Switches on or off; off forgets every image.
  void allow(bool on);
  [[nodiscard]] bool allowed() const;

  /// The latest capture; an earlier one that has not been encoded yet is dropped.
  void offer(LatestCapturePtr latest);

  /// For a request: the latest capture whose images are encoded.  NotFound when switched off,
  /// Unavailable before the first.
  [[nodiscard]] Result<LatestCapturePtr> ask();

  /// Blocks until images are due, encodes them, and returns true; false when asked to stop.  An
  /// encoder's exception ends up in its image; any other costs this capture, not the next.
  bool encode_next(const std::stop_token& stop);

 private:
  [[nodiscard]] bool due() const;

  const SteadyNow steady_now_;
  mutable std::mutex mutex_;  ///< Guards what follows.
  std::condition_variable_any changed_;
  bool on_;
  LatestCapturePtr offered_;
  LatestCapturePtr pictured_;
  std::chrono::steady_clock::time_point asked_{};
  std::chrono::steady_clock::time_point encoded_{};
};

}  // namespace chorus::sensor_service
