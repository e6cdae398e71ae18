// The fused frame over HTTP: /frame, /frames/{seq}, /frame?at=TIME, /skeletons/, /skeletons/{id}.
#pragma once

#include <memory>
#include <string>

#include "common/http/router.h"
#include "common/resource/frame_document.h"
#include "common/resource/place.h"
#include "common/service/frame_ring.h"
#include "fusion-server/sink.h"

namespace chorus::rest {

/// What all documents of one server process share.
struct RestContext {
  std::string instance;  ///< Differs after a restart, so that old ETags never match new frames.
  std::string root = "http://localhost/";  ///< Absolute IRI of `/`, for N-Triples.
};

/// Where a document stands: "sensors/s1/frame", and what precedes the names in it ("sensors/s1/").
[[nodiscard]] resource::Place place_of(const RestContext& context, std::string path,
                                       std::string names = {});

/// Rendering happens on the server's thread and only for what somebody asks for; publish() costs a
/// copy.
class FrameResources final : public Sink {
 public:
  FrameResources(RestContext context, std::size_t ring_capacity);

  [[nodiscard]] std::string_view name() const override { return "rest"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  /// An earlier instant with the frames that came too late for it.
  void amend(const Snapshot& snapshot);

  /// The router keeps using this object, which must outlive it.
  void add_routes(http::Router& router);

 private:
  [[nodiscard]] Result<http::DocumentPtr> frame_at(const http::Request& request) const;
  [[nodiscard]] Result<http::DocumentPtr> frame_of(const std::string& sequence) const;
  [[nodiscard]] Result<http::DocumentPtr> skeletons() const;
  [[nodiscard]] Result<http::DocumentPtr> skeleton(const std::string& id) const;
  RestContext context_;
  service::FrameRing ring_;
  std::shared_ptr<http::LiveDocument> live_;
};

}  // namespace chorus::rest
