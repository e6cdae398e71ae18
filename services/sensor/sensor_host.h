// The running sensor: owns the device's thread, the server and its routes.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "common/http/server.h"
#include "common/service/recordings.h"
#include "services/sensor/sensor_config.h"
#include "services/sensor/sensor_service.h"

namespace chorus::sensor_service {

class SensorHost {
 public:
  explicit SensorHost(Setup setup);
  ~SensorHost();
  SensorHost(const SensorHost&) = delete;
  SensorHost& operator=(const SensorHost&) = delete;

  /// Binds, serves, and starts the device.
  [[nodiscard]] Result<void> start();
  /// Stops device and server; harmless when repeated.
  void stop();

  /// Applies what can change while running and warns of what needs a new start.  A Setup that could
  /// not be read never gets here: the old one stays.
  void reload(Setup wanted);

  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

 private:
  [[nodiscard]] std::shared_ptr<http::Router> routes();
  void record(const Sight& sight);
  void run_device(const std::stop_token& stop);
  std::optional<Result<void>> run_once(const std::stop_token& stop, const FrameSource::Sink& sink);

  Setup setup_;
  service::Recordings recordings_;
  SensorService service_;
  http::Server server_;
  std::jthread device_;
  std::jthread encoder_;  ///< Idle unless images are switched on.
};

}  // namespace chorus::sensor_service
