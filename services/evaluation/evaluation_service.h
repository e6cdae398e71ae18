// The resources of the evaluation: `/evaluation`, `/evaluation/segments`, `/calibrations/{source}`.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <variant>
#include <vector>

#include "common/client/frames.h"
#include "common/client/orientations.h"
#include "common/service/live_documents.h"
#include "common/service/metrics.h"
#include "common/service/self_description.h"
#include "services/evaluation/evaluation_resource.h"

namespace chorus::evaluation_service {

using Frame = client::Arrived<resource::FrameResource>;
using Orientations = client::Arrived<resource::OrientationsResource>;
using Heard = std::variant<Frame, Orientations>;

/// Thread-safe: what is heard comes from one thread, requests from the server's.  A lock holds the
/// judging of what was heard at once (below a millisecond; a calibration takes about ten).
class EvaluationService {
 public:
  EvaluationService(JudgeOptions options, service::Serving serving, std::string title);

  /// The url of the tracker, which documents name.
  void judges(const std::string& tracker);
  /// Judges what was heard, and publishes if there is a new instant.
  void take(const std::vector<Heard>& heard);
  /// The service must outlive the router.
  void add_routes(http::Router& router);
  [[nodiscard]] service::Self description() const;
  /// chorus_evaluation_*, in Prometheus' text.
  void add_metrics(service::MetricsText& text) const;

 private:
  using Answer = Result<http::DocumentPtr>;

  void publish(Timestamp captured);
  [[nodiscard]] Answer segments() const;
  [[nodiscard]] Answer calibration(const std::string& source) const;
  [[nodiscard]] Answer sources() const;
  [[nodiscard]] http::DocumentOptions options() const;

  mutable std::mutex mutex_;  ///< Guards judge_, sequence_ and tracker_.
  LiveJudge judge_;
  std::uint64_t sequence_ = 0;
  std::string tracker_;
  const std::string title_;
  service::LiveDocuments documents_;
};

}  // namespace chorus::evaluation_service
