// /props/: the things that people hold, live, and who takes them up and puts them down.
#pragma once

#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "common/http/live_document.h"
#include "common/http/router.h"
#include "common/resource/node.h"
#include "common/service/serving.h"
#include "common/workplace/prop_board.h"
#include "fusion-server/rest/held_things.h"
#include "fusion-server/sink.h"

namespace chorus::rest {

/// `/props/` at an instant.
[[nodiscard]] resource::Node props_node(Timestamp instant,
                                        const std::vector<workplace::Prop>& props,
                                        const std::vector<workplace::PropAt>& places);

/// Whom a request to take something up means: {"person": 3}, or without a body the only one of
/// `here`.  InvalidArgument: another body.  NotFound: nobody, or not this person, is seen.
/// Conflict: several are, and none is named.
[[nodiscard]] Result<std::uint64_t> parse_holder(std::string_view body,
                                                 const std::vector<std::uint64_t>& here);

class PropResources final : public Sink {
 public:
  PropResources(service::Serving serving, std::shared_ptr<workplace::PropBoard> board);

  [[nodiscard]] std::string_view name() const override { return "props"; }
  void publish(std::shared_ptr<const Snapshot> snapshot) override;
  /// What puts the same things into snapshots.
  [[nodiscard]] HeldThings& held() { return things_; }
  /// This object must outlive the router.
  void add_routes(http::Router& router);

 private:
  [[nodiscard]] Result<http::ActionResult> take_up(const http::Request& request,
                                                   const http::PathParams& params);

  service::Serving serving_;
  std::shared_ptr<workplace::PropBoard> board_;
  workplace::HeldProps held_;  ///< Of the pipeline's thread.
  HeldThings things_;
  std::shared_ptr<http::LiveDocument> live_ = std::make_shared<http::LiveDocument>();
  mutable std::mutex mutex_;
  std::vector<std::uint64_t> here_;  ///< Who is seen now; guarded by mutex_.
};

}  // namespace chorus::rest
