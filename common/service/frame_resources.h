// The resources for the frames of a service, the same for all services: /frame, /frames/{seq},
// /frame?at=TIME, /skeletons/, /skeletons/{id}
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "common/http/router.h"
#include "common/resource/frame_document.h"
#include "common/service/frame_ring.h"
#include "common/service/serving.h"

namespace chorus::service {

/// Thread-safe.  Documents are rendered on the server's thread, and only those that clients ask
/// for.
class FrameResources {
 public:
  FrameResources(Serving serving, const FrameHistory& history);

  /// Sequences must increase within one run of the service.
  void publish(const FramePtr& frame);
  /// Adds a better frame for an instant that has already been published.  Only /frame?at= shows it.
  void amend(FramePtr frame) { ring_.amend(std::move(frame)); }

  /// The router keeps using this object, so the object must outlive it.
  void add_routes(http::Router& router);

 private:
  using Answer = Result<http::DocumentPtr>;

  [[nodiscard]] Answer frame_at(const http::Request& request) const;
  [[nodiscard]] Answer frame_of(const std::string& sequence) const;
  [[nodiscard]] Answer skeletons() const;
  [[nodiscard]] Answer skeleton(const std::string& id) const;

  Serving serving_;
  FrameRing ring_;
  std::shared_ptr<http::LiveDocument> live_;
};

}  // namespace chorus::service
