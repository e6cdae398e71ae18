// One device as resources: takes captures and gives documents; has neither socket nor thread.
//
// on_capture() and on_orientations() run on the device's thread, the routes run on the server's;
// they share one immutable LatestCapture.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/rate_report.h"
#include "common/http/router.h"
#include "common/sensor/frame_source.h"
#include "common/service/common_resources.h"
#include "common/service/frame_resources.h"
#include "common/service/orientation_resources.h"
#include "common/service/self_description.h"
#include "services/sensor/advance.h"
#include "services/sensor/image_desk.h"
#include "services/sensor/latest_capture.h"

namespace chorus::sensor_service {

struct ServiceOptions {
  SensorId id;
  DeviceDescription device;
  service::DocumentHistory history;
  bool images = false;  ///< Off by default, because images show people.
  /// Health is not ready after this time without a capture.
  Duration stall_after = std::chrono::seconds(2);
  service::Serving serving;
  /// Human-readable: why the device delivers nothing at the moment; empty when it does not know.
  std::function<std::string()> trouble = [] { return std::string(); };
  /// Called for each capture; must return at once.
  std::function<void(const LatestCapture&)> record = {};
  /// Called for each document of orientations; must return at once.
  std::function<void(const service::OrientationsPtr&)> record_orientations = {};
  SteadyNow steady_now = [] { return std::chrono::steady_clock::now(); };
};

struct ServiceCounters {
  std::uint64_t captured = 0;  ///< Frames published.
  std::uint64_t lost = 0;      ///< Number of frames missing in the device's numbering.
  std::uint64_t refused = 0;   ///< Captures that could not be true (see on_capture).
  std::uint64_t failures = 0;  ///< Exceptions of the device, of publishing, and of images.
  std::uint64_t bodies = 0;    ///< Bodies in the latest frame.
  std::uint64_t instants = 0;  ///< Instants of inertial sensors taken.
  std::uint64_t sensors = 0;   ///< Inertial sensors in the latest instant.
  double age_s = 0.0;          ///< Since the latest capture arrived; 0 before the first.
};

/// The self-description of a sensor, for `/`.
[[nodiscard]] service::Self self_of(const ServiceOptions& options, bool with_images);

class SensorService {
 public:
  explicit SensorService(ServiceOptions options);

  /// Publishes one capture.  Refuses and counts a capture whose time or number does not advance
  /// (advance.h), with two bodies of the same id, or with too many bodies.  An exception is logged
  /// and counted; the next capture is published as usual.
  void on_capture(Capture capture) noexcept;
  /// Publishes an instant of inertial sensors, with those around it (service::OrientationBatch).
  /// Refuses and counts one whose time or number does not advance, and what inertial::checked()
  /// refuses.
  void on_orientations(inertial::InertialFrame instant) noexcept;
  /// Logs and counts an exception from the device or from another thread of this service.
  void on_failure(std::string_view reason) noexcept;
  /// Call this when the device will deliver nothing more; health() then gives the reason.
  void on_device_end(const Result<void>& how);

  /// Takes effect with the next request.
  void show_images(bool on) { images_.allow(on); }
  /// For a separate thread: blocks until images are due and encodes them; false when told to stop.
  bool encode_next(const std::stop_token& stop) noexcept;

  /// What this sensor is and has at present.
  [[nodiscard]] service::Self description() const { return self_of(options_, images_.allowed()); }
  [[nodiscard]] service::Health health() const;
  [[nodiscard]] ServiceCounters counters() const;

  /// Adds all resources except those of common/service.  The service must outlive the router.
  void add_routes(http::Router& router);

 private:
  using Answer = Result<http::DocumentPtr>;

  void publish(Capture capture);
  void publish(inertial::InertialFrame instant);
  template <class Doing>
  void survive(const Doing& doing) noexcept;
  void refuse(Advance& advance, Timestamp captured, const std::string& reason);
  [[nodiscard]] Result<LatestCapturePtr> latest() const;
  [[nodiscard]] std::string or_trouble(std::string reason) const;
  [[nodiscard]] Answer self() const;
  [[nodiscard]] Answer image(std::shared_ptr<const LazyImage> LatestCapture::*which);
  void add_image_routes(http::Router& router);

  const ServiceOptions options_;
  service::FrameResources frames_;
  service::OrientationResources orientations_;
  service::OrientationBatch batch_;  ///< Used by the device's thread only.
  RateReport refused_{"capture refused"};
  RateReport failures_{"a capture or its images failed", log::Level::Error};
  ImageDesk images_;

  mutable std::mutex mutex_;  ///< Guards the members below.
  LatestCapturePtr latest_;
  Advance frame_order_;
  Advance instant_order_;
  ServiceCounters counters_;
  std::chrono::steady_clock::time_point last_capture_{};
  std::string ended_;  ///< Why the device delivers nothing more; empty while it is running.
};

}  // namespace chorus::sensor_service
