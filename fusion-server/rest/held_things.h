// Puts what people hold into snapshots before they are published.
#pragma once

#include <deque>
#include <memory>
#include <utility>
#include <vector>

#include "common/workplace/prop_board.h"
#include "fusion-server/flow/snapshot.h"

namespace chorus::rest {

/// Of the pipeline's thread.
class HeldThings {
 public:
  explicit HeldThings(std::shared_ptr<const workplace::PropBoard> board);

  /// Sets Snapshot::held of the newest instant.
  void put(Snapshot& snapshot);
  /// An instant that is fused again, with what was put into it the first time, if that is not more
  /// than kKept ago.
  [[nodiscard]] Snapshot again(Snapshot snapshot) const;

  /// Longer than any instant waits to be fused again.
  static constexpr Duration kKept = std::chrono::seconds(10);

 private:
  std::shared_ptr<const workplace::PropBoard> board_;
  workplace::HeldProps held_;
  std::deque<std::pair<Timestamp, std::vector<HeldThing>>> before_;
};

/// The body's hands, where its wrists are now instead of in `then`.
[[nodiscard]] HandsPtr hands_along(const FusedBody& then, const FusedBody& now);

/// The thing, where its holder's joints are now instead of in `then`.
[[nodiscard]] HeldThing carried_along(HeldThing thing, const FusedBody& then, const FusedBody& now);

}  // namespace chorus::rest
