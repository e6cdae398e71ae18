// What is polled, over HTTP: /sensors/, /sensors/{id}, and each sensor's last raw frame.
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
#include "fusion-server/status.h"

namespace chorus::rest {

/// One sensor as a node; `id` is the IRI the document gives it ("" in /sensors/{id}).
[[nodiscard]] resource::Node sensor_node(const SensorStatus& sensor, std::string id);

/// Thread-safe: published from the pipeline's and the poller's thread, read by the server's.
class SensorResources {
 public:
  /// These sensors get a live (long-poll) relay of their frames; those added later answer plain
  /// GETs.
  SensorResources(service::Serving serving, const std::vector<SensorId>& sensors);

  void publish(const std::vector<SensorStatus>& sensors);
  /// The frame as the sensor sent it: its own space, its own clock.
  void relay(const SensorId& sensor, resource::FramePtr frame);
  /// Its floor plane, in its own space; none: it has reported none.
  void floor(const SensorId& sensor, const std::optional<FloorPlane>& floor);

  void add_routes(http::Router& router);

 private:
  [[nodiscard]] std::shared_ptr<http::LiveDocument> live_of(const SensorId& sensor);
  [[nodiscard]] Result<http::DocumentPtr> one(const std::string& id) const;
  [[nodiscard]] Result<http::DocumentPtr> frame_of(const std::string& id) const;
  [[nodiscard]] Result<http::DocumentPtr> floor_of(const std::string& id) const;

  service::Serving serving_;
  std::shared_ptr<http::LiveDocument> list_;
  mutable std::mutex mutex_;
  std::vector<SensorStatus> sensors_;
  std::uint64_t version_ = 0;
  std::map<SensorId, std::shared_ptr<http::LiveDocument>> frames_;
  std::map<SensorId, FloorPlane> floors_;
};

}  // namespace chorus::rest
