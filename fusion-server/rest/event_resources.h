// What happened, over HTTP: /events lists the events of the last day, and streams each of them once
// (Last-Event-ID, ?after=ID).
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/http/router.h"
#include "common/resource/node.h"
#include "common/service/serving.h"
#include "fusion-server/journal/event_log.h"
#include "fusion-server/journal/witness.h"

namespace chorus::rest {

/// One event as a node; its IRI within the document is "#ID".
[[nodiscard]] resource::Node event_node(const journal::Event& event);

/// Thread-safe.
class EventResources {
 public:
  /// Ids of events begin at `first`.
  EventResources(service::Serving serving, std::uint64_t first);

  /// Tells what happened since the glimpse before this one.  Returns these events.
  std::vector<journal::Event> look(journal::Glimpse glimpse);

  void add_routes(http::Router& router);

 private:
  class Kept;
  [[nodiscard]] Result<http::DocumentPtr> list(const http::Request& request) const;
  [[nodiscard]] http::DocumentPtr document(std::uint64_t after) const;

  service::Serving serving_;
  std::shared_ptr<http::LiveDocument> live_;
  std::shared_ptr<Kept> kept_;
  journal::Witness witness_;  ///< Only look() uses it.
};

}  // namespace chorus::rest
