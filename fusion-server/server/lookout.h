// Keeps /people/ and /events: looks at what the other parts of the server publish.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/service/recordings.h"
#include "common/service/serving.h"
#include "common/time/clock.h"
#include "fusion-server/rest/event_resources.h"
#include "fusion-server/rest/people_resources.h"
#include "fusion-server/sink.h"
#include "fusion-server/status/server_status.h"

namespace chorus::server {

struct LookoutOptions {
  service::Serving serving;
  std::shared_ptr<const Clock> clock;
  Duration remember{0};  ///< AssociationConfig::remember.
  service::RecordingConfig recording;
  std::function<void(PersonId)> forget;  ///< Must only post a task and return.
  std::function<std::vector<OutputStatus>()> outputs;
  std::function<std::optional<record::RecordingReport>()> newest_recording;
};

class Lookout {
 public:
  explicit Lookout(LookoutOptions options);

  void add_routes(http::Router& router);
  [[nodiscard]] Sink* people() { return &people_; }
  void remember_for(Duration remember) { people_.remember_for(remember); }

  /// Called on the pipeline's thread with every status.
  void look(const Status& status);

 private:
  [[nodiscard]] std::optional<journal::RecordingGlimpse> recording() const;
  void look_at_disk();

  LookoutOptions options_;
  rest::PeopleResources people_;
  rest::EventResources events_;
  std::optional<double> disk_free_;
  std::chrono::steady_clock::time_point disk_at_{};
};

}  // namespace chorus::server
