// The interface of devices, which yield captures.  Simulators, recordings and hardware all
// implement it.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "common/base/result.h"
#include "common/inertial/inertial_frame.h"
#include "common/sensor/camera_image.h"
#include "common/sensor/sensor_frame.h"

namespace chorus {

/// A resource that the service offers only because of its device.
struct DeviceResource {
  std::string path;  ///< "push"
  std::string what;  ///< Human-readable, half a sentence.
};

/// What the service says about its device at `/`.
struct DeviceDescription {
  std::string kind;   ///< "simulated", "replay", "bridge", ...
  std::string label;  ///< Human-readable: "simulated Kinect v2", "replay of cam01.mcap".
  std::optional<Intrinsics> depth_camera = Intrinsics{};  ///< None: not known.
  double nominal_rate_hz = 30.0;
  std::vector<DeviceResource> resources = {};
  bool bodies = true;         ///< Whether it yields captures of bodies.
  bool orientations = false;  ///< Whether it yields what worn inertial sensors say.
};

/// One capture.  Images are functions, because they are encoded only on demand; each function is
/// called at most once, from another thread.  It is empty when the device has no such image or the
/// settings for privacy forbid it.
struct Capture {
  SensorFrame frame;
  /// True when nothing before holds any more, because another program or camera delivers now: a
  /// frame without a floor plane then means that the floor is unknown.
  bool begins_anew = false;
  std::function<Result<CameraImage>()> color = {};
  std::function<Result<CameraImage>()> depth = {};
};

/// Where a device puts what it yields: captures of bodies, instants of inertial sensors, or both.
class CaptureSink {
 public:
  using TakeBodies = std::function<void(Capture)>;
  using TakeOrientations = std::function<void(inertial::InertialFrame)>;

  CaptureSink(TakeBodies bodies, TakeOrientations orientations)
      : bodies_(std::move(bodies)), orientations_(std::move(orientations)) {}
  /// For who wants bodies only.
  template <std::invocable<Capture> Take>
  CaptureSink(Take bodies)  // NOLINT(google-explicit-constructor)
      : CaptureSink(std::move(bodies), [](const inertial::InertialFrame&) {}) {}

  void operator()(Capture capture) const { bodies_(std::move(capture)); }
  void operator()(inertial::InertialFrame instant) const { orientations_(std::move(instant)); }

 private:
  TakeBodies bodies_;
  TakeOrientations orientations_;
};

class FrameSource {
 public:
  using Sink = CaptureSink;

  virtual ~FrameSource() = default;
  [[nodiscard]] virtual DeviceDescription describe() const = 0;

  /// Delivers captures of each kind in time order, on the calling thread, until stopped or at the
  /// device's end. An error is final; a stop or the end of a recording is success.
  [[nodiscard]] virtual Result<void> run(std::stop_token stop, const Sink& sink) = 0;

  /// Human-readable, one sentence each: what would not work if the device ran on this host now.
  /// May take seconds.  Call it only while the device does not run.
  [[nodiscard]] virtual std::vector<std::string> concerns() const { return {}; }

  /// Human-readable: why the device delivers nothing at the moment; empty when unknown.  May be
  /// called from any thread.
  [[nodiscard]] virtual std::string trouble() const { return {}; }
};

}  // namespace chorus
