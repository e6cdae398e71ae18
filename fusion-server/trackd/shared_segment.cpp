#include "fusion-server/trackd/shared_segment.h"

#include <signal.h>
#include <sys/ipc.h>
#include <sys/shm.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
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

/// Takes a name that only one process can hold and that is freed when the process ends: an abstract
/// socket.  Returns -1 if another process holds it.
int hold(int key) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  const std::string text = "chorus-trackd-" + std::to_string(key);
  std::copy(text.begin(), text.end(), name.sun_path + 1);  // The first byte stays zero.
  const auto bytes = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  const int held = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (held < 0) return -1;
  if (::bind(held, reinterpret_cast<const sockaddr*>(&name), bytes) == 0) return held;  // NOLINT
  ::close(held);
  return -1;
}

/// Why the existing segment cannot be used; empty if it can be used, because an earlier run of ours
/// left it.
std::string objection(const shmid_ds& there, std::size_t bytes) {
  if (there.shm_perm.uid != ::geteuid()) {
    return "it belongs to the user with id " + std::to_string(there.shm_perm.uid);
  }
  if (there.shm_cpid != ::getpid() && alive(there.shm_cpid)) {
    return "process " + std::to_string(there.shm_cpid) + " made it and still runs";
  }
  if (there.shm_segsz != bytes) {
    return "it has " + std::to_string(there.shm_segsz) + " bytes, not " + std::to_string(bytes);
  }
  return {};
}

tl::unexpected<Error> in_the_way(int key, const std::string& why) {
  return fail(ErrorCode::Conflict, named(key),
              "there already: " + why + "; choose another key, or remove it with: ipcrm -M " +
                  std::to_string(key));
}

/// The segment that an earlier run left; readers attached to it keep receiving.
Result<int> left_over(int key, std::size_t bytes) {
  const int id = ::shmget(key, 0, 0);
  if (id < 0) return refused(key, "there already, and not to be looked at");
  shmid_ds there{};
  if (::shmctl(id, IPC_STAT, &there) != 0) return refused(key, "there already");
  if (const std::string why = objection(there, bytes); !why.empty()) return in_the_way(key, why);
  return id;
}

Result<int> new_or_left_over(int key, std::size_t bytes) {
  const int id = ::shmget(key, bytes, IPC_CREAT | IPC_EXCL | kEverybody);
  if (id >= 0) return id;
  if (errno == EEXIST) return left_over(key, bytes);
  return refused(key, "cannot be made");
}

bool has_readers(int id) {
  shmid_ds there{};
  return ::shmctl(id, IPC_STAT, &there) == 0 && there.shm_nattch > 0;
}

}  // namespace

Result<SharedSegment> SharedSegment::create(int key, std::size_t bytes) {
  const int held = hold(key);
  if (held < 0) return in_the_way(key, "another tracker uses it and still runs");
  SharedSegment segment(held);
  const auto id = new_or_left_over(key, bytes);
  if (!id) return pass(id);
  void* const place = ::shmat(*id, nullptr, 0);
  if (place == reinterpret_cast<void*>(-1)) {  // NOLINT: what shmat() says
    const auto error = refused(key, "cannot be attached");
    if (!has_readers(*id)) ::shmctl(*id, IPC_RMID, nullptr);
    return error;
  }
  segment.id_ = *id;
  segment.bytes_ = {static_cast<char*>(place), bytes};
  return segment;
}

SharedSegment::~SharedSegment() {
  if (id_ >= 0) {
    ::shmdt(bytes_.data());
    if (!has_readers(id_)) ::shmctl(id_, IPC_RMID, nullptr);
  }
  if (held_ >= 0) ::close(held_);
}

}  // namespace chorus::trackd
