// The human-readable state of the camera and its runner.  Thread-safe.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/duration.h"
#include "services/sensor/device/camera/lens.h"

namespace chorus::camera {

struct CameraReport {
  std::string source_trouble;  ///< Why no pictures arrive; empty while they do.
  std::string runner_trouble;  ///< Why no runner works; empty while one does.
  bool lens_fits = true;       ///< False: the lens is for pictures of another shape.
  bool over = false;           ///< The video has ended and is not played again.
  std::string doubt;           ///< What is probably wrong although pictures are answered.
  std::string runner;          ///< The runner's name, from its hello.
  std::string layout;
  Size picture;                 ///< Size of the source's pictures [px].
  Size sent;                    ///< Size in which the runner gets them.
  std::uint64_t pictures = 0;   ///< Number of pictures passed on to be looked at.
  std::uint64_t looked_at = 0;  ///< Number of pictures that the runner looked at.
  std::uint64_t connects = 0;   ///< How often the source was opened.
  std::uint64_t starts = 0;     ///< How often a runner has become ready.
  double answer_ms = 0.0;       ///< The runner's time per picture [ms], smoothed.
  double latency_ms = 0.0;      ///< Time from light to landmarks [ms], smoothed.
};

class CameraState {
 public:
  void source_opened();
  void source_failed(std::string why);
  void picture(Size size);
  void runner_ready(std::string name, std::string layout);
  void runner_failed(std::string why);
  void lens_fits(bool fits);
  void answered(Size sent, Duration answer, Duration latency);
  /// Whether all landmarks of the newest picture lie outside of it; none: it shows nobody.
  void outside(std::optional<bool> all);
  void ended();

  [[nodiscard]] CameraReport report() const;
  /// All troubles in one sentence, or that the video has ended; empty if there are none.
  [[nodiscard]] std::string trouble() const;

 private:
  mutable std::mutex mutex_;
  CameraReport report_;
  int outside_in_a_row_ = 0;
};

}  // namespace chorus::camera
