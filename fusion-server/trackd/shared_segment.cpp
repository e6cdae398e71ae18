#include "fusion-server/trackd/shared_segment.h"

#include <signal.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>

namespace chorus::trackd {
namespace {

constexpr int kEverybody = 0666;

std::string named(int key) { return "shared memory key " + std::to_string(key); }

tl::unexpected<Error> refused(int key, const char* by) {
  return fail(ErrorCode::Io, named(key),
              std::string(by) + ": " + std::generic_category().message(errno));
}

bool alive(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

/// Why the segment that is there cannot be replaced; empty: it can, a dead program of ours left it.
std::string objection(const shmid_ds& there, std::size_t bytes) {
  if (there.shm_perm.uid != ::geteuid()) {
    return "it belongs to the user with id " + std::to_string(there.shm_perm.uid);
  }
  if (alive(there.shm_cpid)) {
    return "process " + std::to_string(there.shm_cpid) + " made it and still runs";
  }
  if (there.shm_segsz != bytes) {
    return "it has " + std::to_string(there.shm_segsz) + " bytes, not " + std::to_string(bytes);
  }
  return {};
}

Result<void> remove_left_over(int key, std::size_t bytes) {
  const int id = ::shmget(key, 0, 0);
  if (id < 0) return refused(key, "there already, and not to be looked at");
  shmid_ds there{};
  if (::shmctl(id, IPC_STAT, &there) != 0) return refused(key, "there already");
  if (const std::string why = objection(there, bytes); !why.empty()) {
    return fail(ErrorCode::Conflict, named(key),
                "there already: " + why + "; choose another key, or remove it with: ipcrm -M " +
                    std::to_string(key));
  }
  if (::shmctl(id, IPC_RMID, nullptr) != 0) return refused(key, "left over, not to be removed");
  return {};
}

}  // namespace

Result<SharedSegment> SharedSegment::create(int key, std::size_t bytes) {
  int id = ::shmget(key, bytes, IPC_CREAT | IPC_EXCL | kEverybody);
  if (id < 0 && errno == EEXIST) {
    if (auto ok = remove_left_over(key, bytes); !ok) return pass(ok);
    id = ::shmget(key, bytes, IPC_CREAT | IPC_EXCL | kEverybody);
  }
  if (id < 0) return refused(key, "cannot be made");
  void* const place = ::shmat(id, nullptr, 0);
  if (place == reinterpret_cast<void*>(-1)) {  // NOLINT: what shmat() says
    const auto error = refused(key, "cannot be attached");
    ::shmctl(id, IPC_RMID, nullptr);
    return error;
  }
  return SharedSegment(id, {static_cast<char*>(place), bytes});
}

SharedSegment::~SharedSegment() {
  if (id_ < 0) return;
  ::shmdt(bytes_.data());
  ::shmctl(id_, IPC_RMID, nullptr);
}

}  // namespace chorus::trackd
