// The polled sensors over HTTP: /sensors/, /sensors/{id}, and each sensor's last raw frame and
// floor plane.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "common/http/router.h"
#include "common/resource/frame_document.h"
#include "common/resource/node.h"
#include "common/service/serving.h"
#include "fusion-server/status/sensor_status.h"

namespace chorus::rest {

/// One sensor as a node; `id` is its IRI within the document ("" in /sensors/{id}).
[[nodiscard]] resource::Node sensor_node(const SensorStatus& sensor, std::string id);

/// Thread-safe: the pipeline's and the poller's threads publish, the server's thread reads.
class SensorResources {
 public:
  /// The frames of these sensors are relayed live (by long polling); sensors that are added later
  /// only answer plain GETs.
  SensorResources(service::Serving serving, const std::vector<SensorId>& sensors);

  void publish(const std::vector<SensorStatus>& sensors);
  /// Publishes a frame as the sensor sent it: in its own space, by its own clock.
  void relay(const SensorId& sensor, resource::FramePtr frame);
  /// Publishes a sensor's floor plane, in the sensor's own space; none changes nothing.
  void floor(const SensorId& sensor, const std::optional<FloorPlane>& floor);

  void add_routes(http::Router& router);

 private:
  [[nodiscard]] std::shared_ptr<http::LiveDocument> live_of(const SensorId& sensor);
  [[nodiscard]] Result<http::DocumentPtr> one(const std::string& id) const;
  [[nodiscard]] Result<http::DocumentPtr> frame_of(const std::string& id) const;
  [[nodiscard]] Result<http::DocumentPtr> floor_of(const std::string& id) const;

  std::shared_ptr<const service::Serving> serving_;
  std::shared_ptr<http::LiveDocument> list_;
  mutable std::mutex mutex_;
  std::vector<SensorStatus> sensors_;
  std::uint64_t version_ = 0;
  std::map<SensorId, std::shared_ptr<http::LiveDocument>> frames_;
  std::map<SensorId, FloorPlane> floors_;
};

}  // namespace chorus::rest
