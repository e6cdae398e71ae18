// Keeps on disk what must survive a restart: the registration in use and how far the ids of people
// have come.  The worker writes; what failed is told until something succeeds.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include "fusion-server/server/registration_store.h"
#include "fusion-server/server/worker.h"
#include "fusion-server/status.h"

namespace chorus::server {

class StateKeeper {
 public:
  /// `trouble` is known already (the folder cannot be used); empty: none.
  StateKeeper(RegistrationStore store, std::string trouble);

  void keep(Worker& worker, const Registration& registration);
  void forget(Worker& worker);
  /// Ids of people from `next` on are free; told as often as one likes.
  void people(Worker& worker, std::uint64_t next);

  [[nodiscard]] StorageStatus status() const;

 private:
  /// Outlives this for jobs still on their way.
  struct Shared {
    explicit Shared(RegistrationStore s) : store(std::move(s)) {}
    const RegistrationStore store;
    std::mutex mutex;
    std::string trouble;  ///< Guarded by mutex.
    void note(const Result<void>& done);
  };
  void post(Worker& worker, std::function<Result<void>(const RegistrationStore&)> job);

  std::shared_ptr<Shared> shared_;
  std::uint64_t reserved_ = 0;  ///< Ids of people below this may be used without writing.
};

}  // namespace chorus::server
