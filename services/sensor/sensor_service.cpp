#include "services/sensor/sensor_service.h"

#include <exception>
#include <unordered_set>
#include <utility>

namespace chorus::sensor_service {

using http::PathParams;
using http::Request;

namespace {

// A capture time that goes back by more than this means that the host's clock was set; by less,
// that the device repeats itself.  The fusion server has the same limit.
constexpr Duration kMaxRepeat = std::chrono::seconds(1);

}  // namespace

SensorService::SensorService(ServiceOptions options)
    : options_(std::move(options)),
      frames_(options_.serving, options_.history),
      images_(options_.images, options_.steady_now) {}

/// Why a frame cannot be right; empty if it can.  Call it with the mutex held.
std::string SensorService::objection(const SensorFrame& frame) const {
  if (frame.bodies.size() > kMaxBodies) return "too many bodies";
  std::unordered_set<std::uint64_t> ids;
  for (const BodyFrame& body : frame.bodies) {
    if (!ids.insert(body.id.value).second) return "two bodies have one id";
  }
  if (!latest_) return {};
  const Duration behind = latest_->frame->captured - frame.captured;
  const bool goes_on_from_there =  // The clock was set back.
      behind > Duration::zero() && refused_capture_ && frame.captured > *refused_capture_;
  if (behind >= Duration::zero() && behind <= kMaxRepeat && !goes_on_from_there) {
    return "its capture time does not advance";
  }
  if (frame.sequence <= latest_->frame->sequence) return "its sequence number does not advance";
  return {};
}

void SensorService::on_failure(std::string_view reason) noexcept {
  try {
    failures_.hit(reason);
    const std::lock_guard lock(mutex_);
    ++counters_.failures;
  } catch (...) {  // There is not enough memory even for a log line.
  }
}

void SensorService::on_capture(Capture capture) noexcept {
  try {
    publish(std::move(capture));
  } catch (const std::exception& failure) {
    on_failure(failure.what());
  } catch (...) {
    on_failure("something was thrown that is no exception");
  }
}

bool SensorService::encode_next(const std::stop_token& stop) noexcept {
  try {
    return images_.encode_next(stop);
  } catch (const std::exception& failure) {
    on_failure(failure.what());
  } catch (...) {
    on_failure("something was thrown that is no exception");
  }
  return true;
}

void SensorService::publish(Capture capture) {
  LatestCapturePtr before;
  {
    const std::lock_guard lock(mutex_);
    if (const std::string reason = objection(capture.frame); !reason.empty()) {
      ++counters_.refused;
      refused_.hit(reason);
      refused_capture_ = capture.frame.captured;
      return;
    }
    refused_capture_.reset();
    before = latest_;
  }
  const LatestCapturePtr now = latest_capture(std::move(capture), before.get());
  const std::uint64_t sequence = now->frame->sequence;
  {
    const std::lock_guard lock(mutex_);
    counters_.captured += 1;
    counters_.bodies = now->frame->bodies.size();
    if (before) counters_.lost += sequence - before->frame->sequence - 1;
    latest_ = now;
    last_capture_ = options_.steady_now();
  }
  frames_.publish(now->frame);
  if (options_.record) options_.record(*now);
  images_.offer(now);
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
  if (!latest_) return {false, or_trouble("no frame has been captured yet")};
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
  if (latest_) counters.age_s = seconds(options_.steady_now() - last_capture_);
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
  self.description = "One body-tracking sensor: " + options.device.label + ".";
  self.type = "Sensor";
  self.facts = {{"sensorId", options.id.str()},
                {"deviceKind", options.device.kind},
                {"deviceLabel", options.device.label},
                {"nominalRateHz", resource::Decimal{options.device.nominal_rate_hz, 2}}};
  self.resources = {{"frame", "frame", "the latest frame: all bodies with their joints, live"},
                    {"skeletons/", "skeletons", "the bodies in the latest frame, one by one"},
                    {"floor-plane", "floorPlane", "where the floor is"}};
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
  frames_.add_routes(router);
  router.get("/", [this](const Request&, const PathParams&) { return self(); });
  router.get("/floor-plane", [this](const Request&, const PathParams&) -> Answer {
    return latest().and_then(
        [&](const LatestCapturePtr& now) { return floor_plane(*now, options_.serving); });
  });
  add_image_routes(router);
}

}  // namespace chorus::sensor_service
