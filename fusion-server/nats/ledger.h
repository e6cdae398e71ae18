// Writes to the site's store on a thread of its own, because the store may take its time.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "common/base/handover.h"
#include "fusion-server/nats/broker.h"
#include "fusion-server/site/claim.h"

namespace chorus::nats {

/// Thread-safe.
class Ledger {
 public:
  /// `on_result` runs on the ledger's thread, once for each request that the store answered.
  Ledger(Broker& broker, std::function<void(site::ClaimResult)> on_result);
  ~Ledger();

  /// Newest wins: of more than 256 that wait the oldest are forgotten, and are asked for again.
  void ask(site::ClaimRequest request) { waiting_.give(std::move(request)); }
  /// What bucket chorus_cells says of us; written when it changes and after each new connection.
  void card(std::string cell, std::string text);

 private:
  void run();
  void write(const site::ClaimRequest& request);
  void write_card();

  Broker& broker_;
  std::function<void(site::ClaimResult)> on_result_;
  Handover<site::ClaimRequest> waiting_;
  std::mutex mutex_;
  Entry card_;           ///< Guarded by mutex_.
  std::string written_;  ///< The card that the store has, as of `connection_`.
  std::uint64_t connection_ = 0;
  std::jthread thread_;
};

}  // namespace chorus::nats
