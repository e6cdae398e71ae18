// Camera images, encoded beside the server's thread: rendering and packing takes tens of
// milliseconds, and nobody who waits for a frame should wait for a picture.
//
// While somebody asks, every capture that comes is pictured as fast as it goes; otherwise one a
// second, so that the first answer is not old.  Switched off, nothing is encoded and nothing is
// kept.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>

#include "common/base/result.h"
#include "services/sensor/sight.h"

namespace chorus::sensor_service {

using SteadyNow = std::function<std::chrono::steady_clock::time_point()>;

/// Thread-safe.
class ImageDesk {
 public:
  ImageDesk(bool on, SteadyNow steady_now) : steady_now_(std::move(steady_now)), on_(on) {}

  /// Switches on or off; off forgets every image.
  void allow(bool on);
  [[nodiscard]] bool allowed() const;

  /// The latest capture; an earlier one that was not pictured yet is dropped.
  void offer(SightPtr sight);

  /// For a request: the latest sight whose images are encoded.  NotFound when switched off,
  /// Unavailable before the first.
  [[nodiscard]] Result<SightPtr> ask();

  /// Blocks until images are due, encodes them, and says true; false when asked to stop.  What an
  /// encoder throws is in its image; what is thrown all the same costs this capture, not the next.
  bool encode_next(const std::stop_token& stop);

 private:
  [[nodiscard]] bool due() const;

  const SteadyNow steady_now_;
  mutable std::mutex mutex_;  ///< Guards what follows.
  std::condition_variable_any changed_;
  bool on_;
  SightPtr offered_;
  SightPtr pictured_;
  std::chrono::steady_clock::time_point asked_{};
  std::chrono::steady_clock::time_point encoded_{};
};

}  // namespace chorus::sensor_service
