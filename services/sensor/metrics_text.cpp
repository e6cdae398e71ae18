#include "services/sensor/metrics_text.h"

#include "common/service/metrics.h"

namespace chorus::sensor_service {

std::string metrics_text(const ServiceCounters& service, const http::ServerCounters& server) {
  const auto number = [](std::uint64_t n) { return static_cast<double>(n); };
  service::MetricsText text;
  text.counter({"chorus_frames_captured_total", "Frames published."}, number(service.captured));
  text.counter({"chorus_frames_lost_total", "Gaps in the device's numbering."},
               number(service.lost));
  text.counter({"chorus_captures_refused_total", "Captures that could not be true."},
               number(service.refused));
  text.counter({"chorus_failures_total", "Failures of the device, a capture or its images."},
               number(service.failures));
  text.gauge({"chorus_bodies", "Bodies in the latest frame."}, number(service.bodies));
  text.counter({"chorus_instants_captured_total", "Instants of worn inertial sensors."},
               number(service.instants));
  text.gauge({"chorus_inertial_sensors", "Inertial sensors in the latest instant."},
             number(service.sensors));
  text.gauge({"chorus_frame_age_seconds", "Since the latest frame arrived."}, service.age_s);
  service::add_server(text, server);
  return text.text();
}

}  // namespace chorus::sensor_service
