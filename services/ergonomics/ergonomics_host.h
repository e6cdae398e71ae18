// The running service: follows a tracker, scores on the server's loop, serves the scores.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "common/base/rate_report.h"
#include "common/client/followers.h"
#include "common/http/server.h"
#include "common/service/command_line.h"
#include "common/service/common_resources.h"
#include "common/service/concerns.h"
#include "common/service/serving.h"
#include "common/workplace/scene.h"
#include "services/ergonomics/ergonomics_settings.h"
#include "services/ergonomics/scoring.h"

namespace chorus::ergonomics_service {

/// The resources of the scores.  Frames come from the followers' thread, requests from the
/// server's; a lock holds one frame's scoring (about 0.2 ms a person).
class ErgonomicsService {
 public:
  ErgonomicsService(Scoring scoring, service::Serving serving,
                    std::optional<workplace::Scene> scene = {});

  void take(const resource::FrameResource& frame);
  /// The service must outlive the router.
  void add_routes(http::Router& router);
  [[nodiscard]] service::Self description() const;
  [[nodiscard]] bool scored_any() const;

 private:
  using Answer = Result<http::DocumentPtr>;

  [[nodiscard]] Answer person(const http::Request& request, const http::PathParams& params) const;
  [[nodiscard]] Answer size(const http::PathParams& params) const;
  [[nodiscard]] Answer at_workplace(const http::PathParams& params) const;
  /// Of `person` now, and the version of what is told of them.
  [[nodiscard]] Result<const resource::BodyResource*> body_of(const http::PathParams& params) const;
  [[nodiscard]] Result<http::ActionResult> weigh(const http::Request& request,
                                                 const http::PathParams& params);
  [[nodiscard]] Result<http::ActionResult> stance(const http::PathParams& params);
  [[nodiscard]] Result<http::ActionResult> ask(const http::Request& request);
  [[nodiscard]] http::DocumentPtr asked_document() const;
  void add_methods(http::Router& router);
  void add_persons(http::Router& router);

  mutable std::mutex mutex_;  ///< Guards what follows, up to asked_version_.
  Scoring scoring_;
  resource::FrameResource frame_;            ///< The newest.
  std::map<std::uint64_t, double> weights_;  ///< Of people, as they were told [kg].
  std::uint64_t asked_version_ = 0;
  const std::vector<const ergonomics::Method*> methods_;
  const service::Serving serving_;
  const std::optional<workplace::Scene> scene_;
  std::shared_ptr<http::LiveDocument> live_ = std::make_shared<http::LiveDocument>();
};

class ErgonomicsHost {
 public:
  /// Reads the rules; binds no port.
  [[nodiscard]] static Result<std::unique_ptr<ErgonomicsHost>> make(
      const ErgonomicsSettings& settings);
  ErgonomicsHost(const ErgonomicsSettings& settings, Scoring scoring,
                 std::optional<workplace::Scene> scene);
  ~ErgonomicsHost();
  ErgonomicsHost(const ErgonomicsHost&) = delete;
  ErgonomicsHost& operator=(const ErgonomicsHost&) = delete;

  [[nodiscard]] Result<void> start();
  void stop();
  void take(const LiveSettings& live);
  [[nodiscard]] bool alive() { return server_.alive(); }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

 private:
  [[nodiscard]] std::shared_ptr<http::Router> routes();
  [[nodiscard]] service::Health health() const;

  ErgonomicsSettings settings_;
  ErgonomicsService service_;
  client::Followers followers_;
  http::Server server_;
};

[[nodiscard]] service::About about_ergonomics();

}  // namespace chorus::ergonomics_service
