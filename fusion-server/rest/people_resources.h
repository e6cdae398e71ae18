// The people over HTTP: /people/ lists who is, or lately was, in view; PATCH /people/{id} gives a
// name, POST /people/{id}/forget strikes somebody off.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/http/router.h"
#include "common/resource/node.h"
#include "common/service/serving.h"
#include "fusion-server/journal/roll.h"
#include "fusion-server/sink.h"

namespace chorus::rest {

/// One person as a node; `id` is its IRI within the document ("" in /people/{id}).
[[nodiscard]] resource::Node person_node(const journal::KnownPerson& person, std::string id);

/// Reads {"name": "Anna"}; null takes a name away.  InvalidArgument for anything else.
[[nodiscard]] Result<std::string> parse_naming(std::string_view body);

/// A sink, because snapshots say who is there.  Thread-safe.
class PeopleResources final : public Sink {
 public:
  /// `forget` must only post a task and return; `remember`: see journal::Roll.
  PeopleResources(service::Serving serving, Duration remember,
                  std::function<void(PersonId)> forget);

  [[nodiscard]] std::string_view name() const override { return "people"; }
  /// Publishes the list when it has changed, at most five times a second.
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  void remember_for(Duration remember);
  [[nodiscard]] std::vector<journal::KnownPerson> people() const;

  void add_routes(http::Router& router);

 private:
  void show();
  [[nodiscard]] Result<http::DocumentPtr> one(const std::string& id) const;
  [[nodiscard]] Result<http::ActionResult> rename(const std::string& id, std::string_view body);
  [[nodiscard]] Result<http::ActionResult> forget(const std::string& id);

  service::Serving serving_;
  std::function<void(PersonId)> forget_;
  std::shared_ptr<http::LiveDocument> list_;
  mutable std::mutex mutex_;  ///< Guards the members below.
  journal::Roll roll_;
  std::uint64_t version_ = 0;
  Timestamp shown_{};    ///< Instant of the list that was published last.
  bool changed_ = true;  ///< The list differs from the published one.
};

}  // namespace chorus::rest
