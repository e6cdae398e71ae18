// Stores what must survive a restart: the registration in use, and up to which number person ids
// may have been used.  The worker does the writing; a failure is reported until a later write of
// the same kind succeeds.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "fusion-server/flow/registration.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/server/worker.h"
#include "fusion-server/status/registration_progress.h"

namespace chorus::server {

class StateKeeper {
 public:
  /// `trouble`: an error that is already known (the folder cannot be used); `damage`: as
  /// StorageStatus::damage.  Both are empty if there is none.
  StateKeeper(RegistrationStore store, std::string trouble, std::string damage = {});

  void keep(Worker& worker, const Registration& registration,
            const std::optional<Registration>& earlier = {});
  void forget(Worker& worker);
  /// Notes that person ids are free from `next` on; may be called repeatedly.
  void people(Worker& worker, std::uint64_t next);

  [[nodiscard]] StorageStatus status() const;

 private:
  enum class Kind { Places, People };
  /// Shared with jobs that are still running when this object is destroyed.
  struct Shared {
    explicit Shared(RegistrationStore s) : store(std::move(s)) {}
    const RegistrationStore store;
    std::mutex mutex;
    // Guarded by mutex.
    std::map<Kind, std::string> troubles;
    std::string damage;
    int unwritten = 0;  ///< Number of registrations that wait to be written.
    void note(Kind kind, const Result<void>& done);
  };
  using Job = std::function<Result<void>(const RegistrationStore&)>;
  void post(Worker& worker, Kind kind, Job job);

  std::shared_ptr<Shared> shared_;
  std::uint64_t reserved_ = 0;  ///< Person ids below this may be used without another write.
};

}  // namespace chorus::server
