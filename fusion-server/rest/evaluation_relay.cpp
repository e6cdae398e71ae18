#include "fusion-server/rest/evaluation_relay.h"

namespace chorus::rest {

void EvaluationRelay::follow(client::Followers& followers,
                             std::vector<client::FollowedService> services) {
  followers.follow<client::EvaluationText>(client::kEvaluations, std::move(services),
                                           [this](client::Arrived<client::EvaluationText> arrived) {
                                             relay(std::move(arrived.document));
                                           });
}

void EvaluationRelay::relay(std::shared_ptr<const client::EvaluationText> evaluation) {
  live_->publish_lazily([run = run_, evaluation = std::move(evaluation)] {
    http::DocumentOptions options;
    options.version = run + "-" + std::to_string(evaluation->sequence);
    options.captured = evaluation->captured;
    return http::make_document("application/json", evaluation->json, std::move(options));
  });
}

}  // namespace chorus::rest
