// The resources for the frames of a service, the same for all services: /frame, /frames/{seq},
// /frame?at=TIME, /frame?at=now, /skeletons/, /skeletons/{id}
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "common/http/router.h"
#include "common/resource/frame_document.h"
#include "common/service/live_documents.h"

namespace chorus::service {

using resource::FramePtr;

/// Thread-safe, as LiveDocuments.
class FrameResources {
 public:
  FrameResources(Serving serving, const DocumentHistory& history);

  /// Sequences must increase within one run of the service.
  void publish(const FramePtr& frame) { frames_.publish(resource::document_of_value(frame)); }
  /// Adds a better frame for an instant that has already been published.  Only /frame?at= shows it.
  void amend(const FramePtr& frame) { frames_.amend(resource::document_of_value(frame)); }

  /// What /frame?at=now answers: the frame expected at the present moment, null before the first
  /// one.  Without it nothing is predicted.  Call it before the first request; `now` must be
  /// thread-safe.
  void predict_with(std::function<FramePtr()> now);

  /// The router keeps using this object, so the object must outlive it.
  void add_routes(http::Router& router);

 private:
  using Answer = Result<http::DocumentPtr>;

  [[nodiscard]] FramePtr newest() const;
  [[nodiscard]] Answer skeletons() const;
  [[nodiscard]] Answer skeleton(const std::string& id) const;

  LiveDocuments frames_;
};

}  // namespace chorus::service
