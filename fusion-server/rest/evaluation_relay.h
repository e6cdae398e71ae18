// /evaluation of a tracker that is judged: what its chorus-evaluation says, relayed in JSON, so
// that the viewer and others who know the tracker need no other address.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/client/evaluation.h"
#include "common/client/followers.h"
#include "common/http/router.h"

namespace chorus::rest {

/// Thread-safe.
class EvaluationRelay {
 public:
  /// `run`: of this run of the service, for ETags.
  EvaluationRelay(std::string run, http::Router& router)
      : run_(std::move(run)), live_(std::make_shared<http::LiveDocument>()) {
    router.live("/evaluation", live_);
  }

  /// Relays what these say from now on.  The relay must outlive the followers.
  void follow(client::Followers& followers, std::vector<client::FollowedService> services);
  void relay(std::shared_ptr<const client::EvaluationText> evaluation);

 private:
  std::string run_;
  std::shared_ptr<http::LiveDocument> live_;
};

}  // namespace chorus::rest
