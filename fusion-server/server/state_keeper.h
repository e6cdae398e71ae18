// Stores what must survive a restart: the registration in use, and up to which number person ids
// may have been used.  The worker does the writing; a failure is reported until a later write
// succeeds.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "fusion-server/server/registration_store.h"
#include "fusion-server/server/worker.h"
#include "fusion-server/status.h"

namespace chorus::server {

class StateKeeper {
 public:
  /// `trouble`: an error that is already known (the folder cannot be used); empty if there is none.
  StateKeeper(RegistrationStore store, std::string trouble);

  void keep(Worker& worker, const Registration& registration,
            const std::optional<Registration>& earlier = {});
  void forget(Worker& worker);
  /// Notes that person ids are free from `next` on; may be called repeatedly.
  void people(Worker& worker, std::uint64_t next);

  [[nodiscard]] StorageStatus status() const;

 private:
  /// Shared with jobs that are still running when this object is destroyed.
  struct Shared {
    explicit Shared(RegistrationStore s) : store(std::move(s)) {}
    const RegistrationStore store;
    std::mutex mutex;
    std::string trouble;  ///< Guarded by mutex.
    void note(const Result<void>& done);
  };
  void post(Worker& worker, std::function<Result<void>(const RegistrationStore&)> job);

  std::shared_ptr<Shared> shared_;
  std::uint64_t reserved_ = 0;  ///< Person ids below this may be used without another write.
};

}  // namespace chorus::server
