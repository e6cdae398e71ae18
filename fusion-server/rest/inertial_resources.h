// The followed inertial sources over HTTP: /inertial/, and what each of them said last,
// /inertial/{id}/orientations.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "common/client/followers.h"
#include "common/http/router.h"
#include "common/resource/node.h"
#include "common/resource/orientations_resource.h"
#include "common/service/serving.h"
#include "fusion-server/flow/worn_report.h"

namespace chorus::rest {

/// One source as a node; `id` is its IRI within the document.
[[nodiscard]] resource::Node inertial_source_node(const client::FollowReport& source, Timestamp now,
                                                  std::string id);

/// Adds who wears the source, which limbs it knows, and what is amiss or to be done.
void add_worn(const WornReport& worn, resource::Node& node);

/// What is amiss with a worn source, in sentences for people; empty if nothing is.
[[nodiscard]] std::vector<std::string> worn_sentences(const WornReport& worn);

/// Thread-safe.
class InertialResources {
 public:
  /// What these sources say is relayed live; sources that are added later only answer plain GETs.
  InertialResources(service::Serving serving, const std::vector<SensorId>& sources);

  void publish(const std::vector<client::FollowReport>& sources,
               const std::vector<WornReport>& worn, Timestamp now);
  /// Publishes a document as the source sent it, by its own clock.
  void relay(const SensorId& source,
             std::shared_ptr<const resource::OrientationsResource> orientations);

  void add_routes(http::Router& router);

 private:
  [[nodiscard]] std::shared_ptr<http::LiveDocument> live_of(const SensorId& source);
  [[nodiscard]] Result<http::DocumentPtr> orientations_of(const std::string& id) const;

  std::shared_ptr<const service::Serving> serving_;
  std::shared_ptr<http::LiveDocument> list_;
  mutable std::mutex mutex_;
  std::uint64_t version_ = 0;
  std::map<SensorId, std::shared_ptr<http::LiveDocument>> live_;
};

}  // namespace chorus::rest
