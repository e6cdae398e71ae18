// The running sensor: owns the device's thread, the server and its routes.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/http/server.h"
#include "common/service/command_line.h"
#include "common/service/concerns.h"
#include "common/service/configuration.h"
#include "common/service/recordings.h"
#include "services/sensor/sensor_service.h"
#include "services/sensor/sensor_settings.h"

namespace chorus::sensor_service {

/// What is needed to start: the settings, and a device that is ready to run.
struct Setup {
  SensorSettings settings;
  std::shared_ptr<const Clock> clock;  ///< The host's clock, with its errors.
  std::unique_ptr<FrameSource> device;
  /// Contains the device's routes.
  std::shared_ptr<http::Router> router = std::make_shared<http::Router>();
};

class SensorHost {
 public:
  /// Makes the device; an error if it is missing or not as configured.  Does not bind the port yet.
  [[nodiscard]] static Result<std::unique_ptr<SensorHost>> make(const SensorSettings& settings);
  explicit SensorHost(Setup setup);
  ~SensorHost();
  SensorHost(const SensorHost&) = delete;
  SensorHost& operator=(const SensorHost&) = delete;

  /// Binds the port, serves, and starts the device.
  [[nodiscard]] Result<void> start();
  /// Stops device and server; may be called repeatedly.
  void stop();

  /// Applies everything that can change while the service runs.
  void take(const LiveSettings& live);

  /// Whose facts /configuration shows.
  void tell_of(std::shared_ptr<const service::Configuration> configuration);

  /// What would not work if the service started on this host now.
  [[nodiscard]] service::Concerns concerns() const;

  /// For a watchdog: false if the server's thread hangs (http::Server::alive()).  The device does
  /// not count, because it may be silent for any length of time.
  [[nodiscard]] bool alive() { return server_.alive(); }

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

 private:
  [[nodiscard]] std::shared_ptr<http::Router> routes();
  void record(const LatestCapture& latest);
  void run_device(const std::stop_token& stop);
  std::optional<Result<void>> run_once(const std::stop_token& stop, const FrameSource::Sink& sink);

  Setup setup_;
  std::mutex configuration_mutex_;
  std::shared_ptr<const service::Configuration> configuration_ =
      std::make_shared<service::Configuration>();
  service::Recordings recordings_;
  SensorService service_;
  http::Server server_;
  std::jthread device_;
  std::jthread encoder_;  ///< Idle unless images are switched on.
};

/// How chorus-sensor describes itself.
[[nodiscard]] service::About about_sensor();
/// The same of chorus-positioner, whose device is `positioner` unless another one is named.
[[nodiscard]] service::About about_positioner();

}  // namespace chorus::sensor_service
