#include "fusion-server/server/state_keeper.h"

#include <utility>

#include "common/base/log.h"

namespace chorus::server {
namespace {

constexpr std::uint64_t kReserve = 100;  // Number of person ids that may be skipped after a crash.
constexpr std::uint64_t kMinLeft = kReserve / 2;

}  // namespace

StateKeeper::StateKeeper(RegistrationStore store, std::string trouble, std::string damage)
    : shared_(std::make_shared<Shared>(std::move(store))) {
  shared_->troubles[Kind::Places] = std::move(trouble);
  shared_->damage = std::move(damage);
}

void StateKeeper::Shared::note(Kind kind, const Result<void>& done) {
  const std::scoped_lock lock(mutex);
  const std::string now = done ? std::string() : to_string(done.error());
  std::string& trouble = troubles[kind];
  if (!now.empty() && now != trouble) log::error("state not stored", {{"reason", now}});
  trouble = now;
  if (kind == Kind::People) return;
  --unwritten;
  if (done) damage.clear();
}

void StateKeeper::post(Worker& worker, Kind kind, Job job) {
  if (shared_->store.folder().empty()) return;
  if (kind == Kind::Places) {
    const std::scoped_lock lock(shared_->mutex);
    ++shared_->unwritten;
  }
  worker.post(
      [shared = shared_, kind, job = std::move(job)] { shared->note(kind, job(shared->store)); });
}

void StateKeeper::keep(Worker& worker, const Registration& registration,
                       const std::optional<Registration>& earlier) {
  post(worker, Kind::Places, [registration, earlier](const RegistrationStore& store) {
    return store.save(registration, earlier);
  });
}

void StateKeeper::forget(Worker& worker) {
  post(worker, Kind::Places, [](const RegistrationStore& store) { return store.forget(); });
}

void StateKeeper::people(Worker& worker, std::uint64_t next) {
  if (next + kMinLeft < reserved_) return;
  reserved_ = next + kReserve;
  post(worker, Kind::People, [reserved = reserved_](const RegistrationStore& store) {
    return store.save_next_person(reserved);
  });
}

StorageStatus StateKeeper::status() const {
  const std::scoped_lock lock(shared_->mutex);
  StorageStatus status{shared_->store.folder(), {}, shared_->damage, shared_->unwritten > 0};
  for (const auto& [kind, trouble] : shared_->troubles) {
    if (status.trouble.empty()) status.trouble = trouble;
  }
  return status;
}

}  // namespace chorus::server
