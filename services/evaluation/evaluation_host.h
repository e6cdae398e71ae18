// The running evaluation: follows a tracker and inertial sources, judges on a thread of its own,
// and serves what it finds.
#pragma once

#include <memory>
#include <thread>

#include "common/base/handover.h"
#include "common/client/followers.h"
#include "common/http/server.h"
#include "common/service/command_line.h"
#include "common/service/common_resources.h"
#include "common/service/concerns.h"
#include "services/evaluation/evaluation_service.h"
#include "services/evaluation/evaluation_settings.h"

namespace chorus::evaluation_service {

class EvaluationHost {
 public:
  /// Reads the file of the calibration, if one is named; binds no port.
  [[nodiscard]] static Result<std::unique_ptr<EvaluationHost>> make(
      const EvaluationSettings& settings);
  EvaluationHost(EvaluationSettings settings, JudgeOptions options);
  ~EvaluationHost();
  EvaluationHost(const EvaluationHost&) = delete;
  EvaluationHost& operator=(const EvaluationHost&) = delete;

  void tell_of(std::shared_ptr<const service::Configuration> configuration);
  [[nodiscard]] Result<void> start();
  void stop();
  void take(const LiveSettings& live);
  [[nodiscard]] service::Concerns concerns() const;
  [[nodiscard]] bool alive() { return server_.alive(); }
  [[nodiscard]] std::uint16_t port() const { return server_.port(); }

 private:
  [[nodiscard]] std::shared_ptr<http::Router> routes();
  void follow(const LiveSettings& live);
  void run(const std::stop_token& stop);
  [[nodiscard]] service::Health health() const;
  [[nodiscard]] std::string metrics() const;

  EvaluationSettings settings_;
  std::shared_ptr<const service::Configuration> configuration_ =
      std::make_shared<service::Configuration>();
  EvaluationService service_;
  /// Seconds of a tracker and several suits; the oldest are dropped when judging falls behind.
  Handover<Heard> inbox_{1024};
  client::Followers followers_;
  http::Server server_;
  std::jthread thread_;
};

/// The options of the judge, with the calibrations of the file that the settings name.
[[nodiscard]] Result<JudgeOptions> judge_options(const EvaluationSettings& settings);

/// How chorus-evaluation describes itself.
[[nodiscard]] service::About about_evaluation();

}  // namespace chorus::evaluation_service
