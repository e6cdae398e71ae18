#include "fusion-server/nats/ledger.h"

#include <utility>

#include "fusion-server/nats/cell_records.h"
#include "fusion-server/nats/subjects.h"

namespace chorus::nats {
namespace {

constexpr std::size_t kRequests = 256;
constexpr std::chrono::milliseconds kLedgerPatience{200};

}  // namespace

Ledger::Ledger(Broker& broker, std::function<void(site::ClaimResult)> on_result)
    : broker_(broker), on_result_(std::move(on_result)), waiting_(kRequests) {
  thread_ = std::jthread([this] { run(); });
}

Ledger::~Ledger() { waiting_.close(); }

void Ledger::card(std::string cell, std::string text) {
  const std::scoped_lock lock(mutex_);
  card_ = {std::move(cell), std::move(text), 0};
}

void Ledger::run() {
  while (!waiting_.closed()) {
    for (const site::ClaimRequest& request : waiting_.take(kLedgerPatience)) {
      if (waiting_.closed()) return;
      write(request);
    }
    write_card();
  }
}

void Ledger::write(const site::ClaimRequest& request) {
  const std::string key = claim_key(request.value.id);
  const auto written =
      broker_.update(kPeopleBucket, {key, write_claim(request.value), request.expected});
  site::ClaimResult result{request.value, written.has_value()};
  result.now.revision = written.value_or(0);
  if (written) return on_result_(std::move(result));
  if (written.error().code != ErrorCode::Conflict) return;  // The core asks again.
  const auto entry = broker_.get(kPeopleBucket, key);
  // The record was there once and is too old now.
  if (!entry && entry.error().code == ErrorCode::NotFound) return on_result_(std::move(result));
  if (!entry) return;
  auto now = read_claim(key, entry->value, entry->revision);
  if (now) on_result_({std::move(*now), false});
}

void Ledger::write_card() {
  Entry card;
  {
    const std::scoped_lock lock(mutex_);
    card = card_;
  }
  const BrokerStatus status = broker_.status();
  if (!status.connected || card.key.empty()) return;
  if (card.value == written_ && status.connects == connection_) return;
  if (!broker_.put(kCellsBucket, card)) return;
  written_ = card.value;
  connection_ = status.connects;
}

}  // namespace chorus::nats
