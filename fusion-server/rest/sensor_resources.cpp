#include "fusion-server/rest/sensor_resources.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "common/base/log.h"
#include "common/base/units.h"
#include "common/resource/floor_plane_resource.h"
#include "fusion-server/core/common_clock.h"

namespace chorus::rest {
namespace {

double milliseconds_of(Duration d) { return std::chrono::duration<double, std::milli>(d).count(); }

std::array<std::pair<std::string_view, std::uint64_t>, 6> counted(const FrameFates& fates) {
  return {{{"framesLate", fates.late},
           {"framesDoubled", fates.doubled},
           {"framesEarly", fates.early},
           {"framesBackwards", fates.backwards},
           {"framesStale", fates.stale},
           {"clockRestarts", fates.restarts}}};
}

/// The clock of the sensor's host: by how much it is off, how that was found, and what the host
/// says of its own clock.
void add_clock(resource::Node& node, const SensorStatus& sensor) {
  auto& out = node.properties;
  const auto put = [&](const char* key, Duration value) {
    out.emplace_back(key, resource::Decimal{milliseconds_of(value), 3});
  };
  if (const auto offset = total_offset(sensor)) put("clockOffsetMilliseconds", *offset);
  if (sensor.walked_offset && sensor.guessed_from_age) {
    put("clockUncertaintyMilliseconds", core::kOldestFrames);
    put("clockFromAgeMilliseconds", *sensor.walked_offset);
  } else if (sensor.walked_offset) {
    put("clockUncertaintyMilliseconds", 2 * sensor.walked_sigma.value_or(Duration{0}));
    put("clockFromWalkMilliseconds", *sensor.walked_offset);
    if (sensor.clock_uncertainty)
      put("clockUncertaintyWithoutWalkMilliseconds", *sensor.clock_uncertainty);
  } else if (sensor.clock_uncertainty) {
    put("clockUncertaintyMilliseconds", *sensor.clock_uncertainty);
  }
  if (sensor.clock_uncertainty || sensor.walked_offset)
    out.emplace_back("clockCorrected", sensor.clock_corrected || sensor.walked_offset);
  if (sensor.latency) {
    put("latencyMilliseconds", sensor.latency->found);
    put("latencyUncertaintyMilliseconds", sensor.latency->sigma);
    out.emplace_back("latencyCorrected", sensor.latency->applied);
  }
  if (!sensor.host) return;
  out.emplace_back("hostSynchronised", sensor.host->synchronised);
  put("hostEstimatedErrorMilliseconds", sensor.host->est_error);
  put("hostMaximumErrorMilliseconds", sensor.host->max_error);
}

}  // namespace

resource::Node sensor_node(const SensorStatus& sensor, std::string id) {
  using resource::Decimal;
  resource::Node node{std::move(id), {"PolledSensor"}, {}};
  auto& out = node.properties;
  out.emplace_back("sensorId", sensor.id.str());
  out.emplace_back("url", resource::Ref{sensor.url});
  out.emplace_back("state", sensor.state);
  out.emplace_back("transport", std::string(sensor.streaming ? "stream" : "poll"));
  if (sensor.age) out.emplace_back("ageMilliseconds", Decimal{milliseconds_of(*sensor.age), 1});
  out.emplace_back("rateHz", Decimal{sensor.rate_hz, 2});
  out.emplace_back("bodies", static_cast<std::int64_t>(sensor.bodies));
  if (sensor.weight) out.emplace_back("weight", Decimal{*sensor.weight, 3});
  out.emplace_back("share", Decimal{sensor.share, 3});
  out.emplace_back("shareAfterwards", Decimal{sensor.share_afterwards, 3});
  out.emplace_back("awaited", Decimal{sensor.awaited, 3});
  add_clock(node, sensor);
  out.emplace_back("framesReceived", static_cast<std::int64_t>(sensor.frames));
  out.emplace_back("framesMissed", static_cast<std::int64_t>(sensor.missed));
  out.emplace_back("framesRefused", static_cast<std::int64_t>(sensor.refused));
  for (const auto& [key, count] : counted(sensor.fates)) {
    if (count > 0) out.emplace_back(std::string(key), static_cast<std::int64_t>(count));
  }
  if (sensor.shift) out.emplace_back("displacedMillimetres", Decimal{to_mm(*sensor.shift), 1});
  if (!sensor.alarm.empty()) out.emplace_back("alarm", sensor.alarm);
  if (!sensor.contested.empty()) out.emplace_back("contested", sensor.contested);
  if (!sensor.last_error.empty()) out.emplace_back("lastError", sensor.last_error);
  out.emplace_back("frame", resource::Ref{"/sensors/" + sensor.id.str() + "/frame"});
  return node;
}

SensorResources::SensorResources(service::Serving serving, const std::vector<SensorId>& sensors)
    : serving_(std::make_shared<const service::Serving>(std::move(serving))),
      list_(std::make_shared<http::LiveDocument>()) {
  for (const SensorId& sensor : sensors) frames_[sensor] = std::make_shared<http::LiveDocument>();
}

void SensorResources::publish(const std::vector<SensorStatus>& sensors) {
  resource::Node node{"", {"SensorList", "ldp:BasicContainer", "ldp:Container"}, {}};
  std::vector<resource::Ref> contains;
  std::vector<resource::Node> members;
  for (const SensorStatus& sensor : sensors) {
    contains.push_back({sensor.id.str()});
    members.push_back(sensor_node(sensor, sensor.id.str()));
  }
  node.properties.emplace_back("title", std::string("polled sensors"));
  node.properties.emplace_back("contains", std::move(contains));
  node.properties.emplace_back("sensors", std::move(members));
  http::DocumentOptions options;
  {
    const std::scoped_lock lock(mutex_);
    sensors_ = sensors;
    options.version = serving_->run + "-" + std::to_string(++version_);
  }
  options.headers = {{"Accept-Post", "application/json"}};
  list_->publish(resource::document_of(std::move(node), std::move(options),
                                       serving_->place("sensors/"), resource::Kind::Container));
}

std::shared_ptr<http::LiveDocument> SensorResources::live_of(const SensorId& sensor) {
  const std::scoped_lock lock(mutex_);
  auto& live = frames_[sensor];
  if (!live) live = std::make_shared<http::LiveDocument>();
  return live;
}

void SensorResources::relay(const SensorId& sensor, resource::FramePtr frame) {
  // The document may outlive this object, and is rarely asked for.
  live_of(sensor)->publish_lazily([serving = serving_, sensor, frame = std::move(frame)] {
    const std::string folder = "sensors/" + sensor.str() + "/";
    auto options = resource::latest_options(*frame, serving->run);
    options.content_location.clear();
    return resource::frame_document(frame, serving->place(folder + "frame", folder),
                                    std::move(options));
  });
}

Result<http::DocumentPtr> SensorResources::one(const std::string& id) const {
  http::DocumentOptions options;
  const std::scoped_lock lock(mutex_);
  const auto it = std::find_if(sensors_.begin(), sensors_.end(),
                               [&](const SensorStatus& s) { return s.id.str() == id; });
  if (it == sensors_.end()) {
    return fail(ErrorCode::NotFound, "sensors/" + id, "no sensor of this id is polled");
  }
  options.version = serving_->run + "-" + std::to_string(version_);
  return resource::document_of(sensor_node(*it, ""), std::move(options),
                               serving_->place("sensors/" + id));
}

Result<http::DocumentPtr> SensorResources::frame_of(const std::string& id) const {
  const auto sensor = SensorId::parse(id);
  const std::scoped_lock lock(mutex_);
  const auto it = sensor ? frames_.find(*sensor) : frames_.end();
  if (it == frames_.end()) {
    return fail(ErrorCode::NotFound, "sensors/" + id, "no sensor of this id is polled");
  }
  if (auto document = it->second->current()) return document;
  return fail(ErrorCode::Unavailable, "sensors/" + id + "/frame",
              "this sensor has not delivered a frame yet");
}

void SensorResources::floor(const SensorId& sensor, const std::optional<FloorPlane>& floor) {
  const std::scoped_lock lock(mutex_);
  if (floor) floors_[sensor] = *floor;
}

Result<http::DocumentPtr> SensorResources::floor_of(const std::string& id) const {
  const std::string path = "sensors/" + id + "/floor-plane";
  const auto sensor = SensorId::parse(id);
  const std::scoped_lock lock(mutex_);
  const auto it = sensor ? floors_.find(*sensor) : floors_.end();
  if (it == floors_.end())
    return fail(ErrorCode::NotFound, path, "no sensor of this id has told where its floor is");
  const FloorPlane& floor = it->second;
  http::DocumentOptions options;
  options.version = serving_->run;
  for (const double v : {floor.normal.x(), floor.normal.y(), floor.normal.z(), floor.offset})
    options.version += "-" + log::number_text(v);
  return resource::document_of(resource::floor_plane_node(floor, resource::SpaceKind::Sensor),
                               std::move(options), serving_->place(path));
}

void SensorResources::add_routes(http::Router& router) {
  router.live("/sensors/", list_);
  router.get("/sensors/{id}", [this](const http::Request&, const http::PathParams& params) {
    return one(params.at("id"));
  });
  router.get("/sensors/{id}/frame", [this](const http::Request&, const http::PathParams& params) {
    return frame_of(params.at("id"));
  });
  router.get("/sensors/{id}/floor-plane",
             [this](const http::Request&, const http::PathParams& params) {
               return floor_of(params.at("id"));
             });
  for (const auto& [sensor, live] : frames_) {
    router.live("/sensors/" + sensor.str() + "/frame", live);
  }
}

}  // namespace chorus::rest
