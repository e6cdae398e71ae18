// The resources for the frames of a service, the same for all services: /frame, /frames/{seq},
// /frame?at=TIME, /frame?at=now, /skeletons/, /skeletons/{id}
#pragma once

#include <functional>
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

  /// What /frame?at=now answers: the frame expected at the present moment, null before the first
  /// one.  Without it nothing is predicted.  Call it before the first request; `now` must be
  /// thread-safe.
  void predict_with(std::function<FramePtr()> now) { now_ = std::move(now); }

  /// The router keeps using this object, so the object must outlive it.
  void add_routes(http::Router& router);

 private:
  using Answer = Result<http::DocumentPtr>;

  [[nodiscard]] Answer frame_at(const http::Request& request) const;
  [[nodiscard]] Result<FramePtr> frame_of_time(const std::string& time) const;
  [[nodiscard]] Answer frame_of(const std::string& sequence) const;
  [[nodiscard]] Answer skeletons() const;
  [[nodiscard]] Answer skeleton(const std::string& id) const;

  Serving serving_;
  FrameRing ring_;
  std::function<FramePtr()> now_;
  std::shared_ptr<http::LiveDocument> live_;
};

}  // namespace chorus::service
