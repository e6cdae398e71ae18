// Encodes camera images off the server's thread: rendering and packing takes tens of milliseconds,
// and a request for a frame must not wait for an image.
//
// While clients ask, captures are encoded as fast as possible; otherwise once a second, so that the
// first answer is recent.  While switched off, nothing is encoded.
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

  /// Switches encoding on or off; off drops the encoded capture.
  void allow(bool on);
  [[nodiscard]] bool allowed() const;

  /// Offers the latest capture; it replaces an earlier one that has not been encoded yet.
  void offer(LatestCapturePtr latest);

  /// For a request: the latest capture with encoded images.  NotFound when switched off,
  /// Unavailable before the first one.
  [[nodiscard]] Result<LatestCapturePtr> ask();

  /// Blocks until images are due, encodes them, and returns true; false when told to stop.  An
  /// encoder's exception becomes the image's Error.  Any other exception is rethrown, after this
  /// capture has been dropped, so that the next call encodes the next capture.
  bool encode_next(const std::stop_token& stop);

 private:
  [[nodiscard]] bool due() const;

  const SteadyNow steady_now_;
  mutable std::mutex mutex_;  ///< Guards the members below.
  std::condition_variable_any changed_;
  bool on_;
  LatestCapturePtr offered_;
  LatestCapturePtr pictured_;
  std::chrono::steady_clock::time_point asked_{};
  std::chrono::steady_clock::time_point encoded_{};
};

}  // namespace chorus::sensor_service
