#include "fusion-server/server/state_keeper.h"

#include <utility>

#include "common/base/log.h"

namespace chorus::server {
namespace {

constexpr std::uint64_t kReserve = 100;  // Number of person ids that may be skipped after a crash.
constexpr std::uint64_t kMinLeft = kReserve / 2;

}  // namespace

StateKeeper::StateKeeper(RegistrationStore store, std::string trouble)
    : shared_(std::make_shared<Shared>(std::move(store))) {
  shared_->trouble = std::move(trouble);
}

void StateKeeper::Shared::note(const Result<void>& done) {
  const std::scoped_lock lock(mutex);
  const std::string now = done ? std::string() : to_string(done.error());
  if (!now.empty() && now != trouble) log::error("state not stored", {{"reason", now}});
  trouble = now;
}

void StateKeeper::post(Worker& worker, std::function<Result<void>(const RegistrationStore&)> job) {
  if (shared_->store.folder().empty()) return;
  worker.post([shared = shared_, job = std::move(job)] { shared->note(job(shared->store)); });
}

void StateKeeper::keep(Worker& worker, const Registration& registration,
                       const std::optional<Registration>& earlier) {
  post(worker, [registration, earlier](const RegistrationStore& store) {
    return store.save(registration, earlier);
  });
}

void StateKeeper::forget(Worker& worker) {
  post(worker, [](const RegistrationStore& store) { return store.forget(); });
}

void StateKeeper::people(Worker& worker, std::uint64_t next) {
  if (next + kMinLeft < reserved_) return;
  reserved_ = next + kReserve;
  post(worker, [reserved = reserved_](const RegistrationStore& store) {
    return store.save_next_person(reserved);
  });
}

StorageStatus StateKeeper::status() const {
  const std::scoped_lock lock(shared_->mutex);
  return {shared_->store.folder(), shared_->trouble};
}

}  // namespace chorus::server
