#include "services/sensor/sensor_service.h"

#include <exception>
#include <unordered_set>
#include <utility>

namespace chorus::sensor_service {

using http::PathParams;
using http::Request;

namespace {

/// Why a frame cannot be right, whatever came before it; empty if it can.
std::string objection_to(const SensorFrame& frame) {
  if (frame.bodies.size() > kMaxBodies) return "too many bodies";
  std::unordered_set<std::uint64_t> ids;
  for (const BodyFrame& body : frame.bodies) {
    if (!ids.insert(body.id.value).second) return "two bodies have one id";
  }
  return {};
}

}  // namespace

SensorService::SensorService(ServiceOptions options)
    : options_(std::move(options)),
      frames_(options_.serving, options_.history),
      orientations_(options_.serving, options_.history),
      images_(options_.images, options_.steady_now) {}

void SensorService::on_failure(std::string_view reason) noexcept {
  try {
    failures_.hit(reason);
    const std::lock_guard lock(mutex_);
    ++counters_.failures;
  } catch (...) {  // There is not enough memory even for a log line.
  }
}

template <class Doing>
void SensorService::survive(const Doing& doing) noexcept {
  try {
    doing();
  } catch (const std::exception& failure) {
    on_failure(failure.what());
  } catch (...) {
    on_failure("something was thrown that is no exception");
  }
}

void SensorService::on_capture(Capture capture) noexcept {
  survive([&] { publish(std::move(capture)); });
}

void SensorService::on_orientations(inertial::InertialFrame instant) noexcept {
  survive([&] { publish(std::move(instant)); });
}

bool SensorService::encode_next(const std::stop_token& stop) noexcept {
  bool more = true;
  survive([&] { more = images_.encode_next(stop); });
  return more;
}

/// Call it with the mutex held.
void SensorService::refuse(Advance& advance, Timestamp captured, const std::string& reason) {
  ++counters_.refused;
  refused_.hit(reason);
  advance.refuse(captured);
}

void SensorService::publish(Capture capture) {
  const SensorFrame& frame = capture.frame;
  LatestCapturePtr before;
  {
    const std::lock_guard lock(mutex_);
    std::string reason = objection_to(frame);
    if (reason.empty()) reason = frame_order_.objection(frame.sequence, frame.captured);
    if (!reason.empty()) return refuse(frame_order_, frame.captured, reason);
    before = latest_;
  }
  const LatestCapturePtr now = latest_capture(std::move(capture), before.get());
  {
    const std::lock_guard lock(mutex_);
    counters_.captured += 1;
    counters_.bodies = now->frame->bodies.size();
    counters_.lost += frame_order_.take(now->frame->sequence, now->frame->captured);
    latest_ = now;
    last_capture_ = options_.steady_now();
  }
  frames_.publish(now->frame);
  if (options_.record) options_.record(*now);
  images_.offer(now);
}

void SensorService::publish(inertial::InertialFrame instant) {
  const Timestamp captured = instant.captured;
  const auto now = options_.steady_now();
  auto checked = inertial::checked(std::move(instant));
  {
    const std::lock_guard lock(mutex_);
    const std::string reason = checked ? instant_order_.objection(checked->sequence, captured)
                                       : to_string(checked.error());
    if (!reason.empty()) return refuse(instant_order_, captured, reason);
    counters_.lost += instant_order_.take(checked->sequence, captured);
    counters_.instants += 1;
    counters_.sensors = checked->readings.size();
    last_capture_ = now;
  }
  const auto document = batch_.add(std::move(*checked), now.time_since_epoch());
  if (!document) return;
  orientations_.publish(document);
  if (options_.record_orientations) options_.record_orientations(document);
}

void SensorService::on_device_end(const Result<void>& how) {
  const std::lock_guard lock(mutex_);
  ended_ = how ? or_trouble("the device has come to its end")
               : "the device failed: " + to_string(how.error());
}

/// The device's own reason if it gives one, otherwise `reason`.
std::string SensorService::or_trouble(std::string reason) const {
  std::string known = options_.trouble();
  return known.empty() ? reason : known;
}

service::Health SensorService::health() const {
  const std::lock_guard lock(mutex_);
  if (!ended_.empty()) return {false, ended_};
  if (!frame_order_.begun() && !instant_order_.begun())
    return {false, or_trouble("no frame has been captured yet")};
  const Duration silent = options_.steady_now() - last_capture_;
  if (silent > options_.stall_after) {
    return {false, or_trouble("the device has been silent for " +
                              std::to_string(static_cast<long>(seconds(silent))) + " s")};
  }
  return {};
}

ServiceCounters SensorService::counters() const {
  const std::lock_guard lock(mutex_);
  ServiceCounters counters = counters_;
  if (frame_order_.begun() || instant_order_.begun())
    counters.age_s = seconds(options_.steady_now() - last_capture_);
  return counters;
}

Result<LatestCapturePtr> SensorService::latest() const {
  const std::lock_guard lock(mutex_);
  if (!latest_)
    return fail(ErrorCode::Unavailable, "sensor", or_trouble("no frame has been captured yet"));
  return latest_;
}

service::Self self_of(const ServiceOptions& options, bool with_images) {
  service::Self self;
  self.title = "Sensor " + options.id.str();
  self.description = std::string(options.device.bodies ? "One body-tracking sensor: "
                                                       : "Worn inertial sensors: ") +
                     options.device.label + ".";
  self.type = "Sensor";
  self.facts = {{"sensorId", options.id.str()},
                {"deviceKind", options.device.kind},
                {"deviceLabel", options.device.label},
                {"nominalRateHz", resource::Decimal{options.device.nominal_rate_hz, 2}}};
  if (options.device.bodies) {
    self.resources = {{"frame", "frame", "the latest frame: all bodies with their joints, live"},
                      {"skeletons/", "skeletons", "the bodies in the latest frame, one by one"},
                      {"floor-plane", "floorPlane", "where the floor is"}};
  }
  if (options.device.orientations)
    self.resources.push_back({"orientations", "orientations", "what worn sensors say, live"});
  for (const DeviceResource& own : options.device.resources)
    self.resources.push_back({own.path, "", own.what});
  if (!with_images) return self;
  self.resources.insert(
      self.resources.end(),
      {{"images/", "", "the camera images and their intrinsics"},
       {"images/color", "colorImage", "the latest colour image, JPEG"},
       {"images/depth", "depthImage", "the latest depth image, 16-bit PNG in millimetres"}});
  return self;
}

SensorService::Answer SensorService::self() const {
  const bool images = images_.allowed();
  return service::self_document(self_of(options_, images), options_.serving,
                                images ? "images" : "plain");
}

SensorService::Answer SensorService::image(std::shared_ptr<const LazyImage> LatestCapture::*which) {
  const auto pictured = images_.ask();
  if (!pictured) return pass(pictured);
  const auto& image = **pictured.*which;
  if (!image) return fail(ErrorCode::NotFound, "images", "this device has no such images");
  return image_document(*image, (*pictured)->frame->sequence, options_.serving);
}

void SensorService::add_image_routes(http::Router& router) {
  router.get("/images/", [this](const Request&, const PathParams&) -> Answer {
    return images_.ask().map(
        [this](const LatestCapturePtr& now) { return image_list(*now, options_.serving); });
  });
  router.shows_people("/images/color");
  router.shows_people("/images/depth");
  router.get("/images/color",
             [this](const Request&, const PathParams&) { return image(&LatestCapture::color); });
  router.get("/images/depth",
             [this](const Request&, const PathParams&) { return image(&LatestCapture::depth); });
}

void SensorService::add_routes(http::Router& router) {
  if (options_.device.orientations) orientations_.add_routes(router);
  router.get("/", [this](const Request&, const PathParams&) { return self(); });
  if (!options_.device.bodies) return;
  frames_.add_routes(router);
  router.get("/floor-plane", [this](const Request&, const PathParams&) -> Answer {
    return latest().and_then(
        [&](const LatestCapturePtr& now) { return floor_plane(*now, options_.serving); });
  });
  add_image_routes(router);
}

}  // namespace chorus::sensor_service
