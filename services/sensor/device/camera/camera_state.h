// How the camera and its runner are doing, for people.  Thread-safe.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "common/base/duration.h"
#include "services/sensor/device/camera/lens.h"

namespace chorus::camera {

struct CameraReport {
  std::string source_trouble;  ///< Why no pictures come; empty while they do.
  std::string runner_trouble;  ///< Why nobody looks at them; empty while somebody does.
  std::string runner;          ///< Its name, from its hello.
  std::string layout;
  Size picture;                 ///< As the source gives them.
  Size sent;                    ///< As the runner gets them.
  std::uint64_t pictures = 0;   ///< From the source.
  std::uint64_t looked_at = 0;  ///< By the runner.
  std::uint64_t connects = 0;   ///< How often the source was opened.
  std::uint64_t starts = 0;     ///< How often the runner was started.
  double answer_ms = 0.0;       ///< What the runner takes for an image, smoothed.
  double latency_ms = 0.0;      ///< From light to landmarks, smoothed.
};

class CameraState {
 public:
  void source_opened();
  void source_failed(std::string why);
  void picture(Size size);
  void runner_ready(std::string name, std::string layout);
  void runner_failed(std::string why);
  void answered(Size sent, Duration answer, Duration latency);

  [[nodiscard]] CameraReport report() const;
  /// Both troubles in one sentence; empty when there are none.
  [[nodiscard]] std::string trouble() const;

 private:
  mutable std::mutex mutex_;
  CameraReport report_;
};

}  // namespace chorus::camera
