// What worn inertial sensors say, over HTTP: /orientations, /orientations/{seq},
// /orientations?at=TIME; at most fifty documents a second, whatever the sensors' rate.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/resource/orientations_resource.h"
#include "common/service/live_documents.h"

namespace chorus::service {

using OrientationsPtr = std::shared_ptr<const resource::OrientationsResource>;

/// Collects instants into documents.  Not thread-safe; time is an argument.
class OrientationBatch {
 public:
  /// The time between two documents, at least.
  static constexpr Duration kInterval = std::chrono::milliseconds(20);
  /// Readings after which a document is full: what readers take has 2 MB, a reading at most 1.1 kB.
  static constexpr std::size_t kMaxReadings = 1700;

  /// Takes an instant at the steady time `now`.  Returns the document of all instants since the
  /// last one if that is kInterval ago, or if it is full; otherwise null.
  [[nodiscard]] OrientationsPtr add(inertial::InertialFrame instant, Duration now);

 private:
  std::vector<inertial::InertialFrame> waiting_;
  std::size_t readings_ = 0;  ///< Of those that wait.
  std::optional<Duration> given_at_;
  std::uint64_t given_ = 0;  ///< Number of documents so far.
};

/// Thread-safe, as LiveDocuments.
class OrientationResources {
 public:
  OrientationResources(Serving serving, const DocumentHistory& history);

  void publish(const OrientationsPtr& orientations) {
    documents_.publish(resource::document_of_value(orientations));
  }
  void add_routes(http::Router& router) { documents_.add_routes(router); }

 private:
  LiveDocuments documents_;
};

}  // namespace chorus::service
