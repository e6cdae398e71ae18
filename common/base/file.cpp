#include "common/base/file.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

namespace chorus {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> io_error(const fs::path& path, const std::string& what) {
  return fail(ErrorCode::Io, path.string(), what + ": " + std::strerror(errno));
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { (void)close(); }
  [[nodiscard]] int get() const { return fd_; }
  /// What kind of file it is; 0 if that cannot be told.
  [[nodiscard]] mode_t mode() const {
    struct stat about {};
    return ::fstat(fd_, &about) == 0 ? about.st_mode : 0;
  }
  [[nodiscard]] bool close() {
    const int fd = std::exchange(fd_, -1);
    return fd < 0 || ::close(fd) == 0;
  }

 private:
  int fd_;
};

constexpr int kPatienceMs = 10'000;  ///< For whoever is at the other end of a pipe.

/// Waits until a descriptor that does not block can go on; false, with errno, when it cannot.
bool ready(int fd, short what) {
  pollfd one{fd, what, 0};
  const int got = ::poll(&one, 1, kPatienceMs);
  if (got == 0) errno = ETIMEDOUT;
  return got > 0;
}

/// Opens what may also be a pipe, without waiting for its other end.
Result<std::unique_ptr<Descriptor>> opened(const fs::path& path) {
  auto file = std::make_unique<Descriptor>(
      ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file->get() >= 0) return file;
  if (errno == ENOENT) return fail(ErrorCode::NotFound, path.string(), "there is no such file");
  if (errno == ELOOP)
    return fail(ErrorCode::Io, path.string(), "is a link that leads back to itself; remove it");
  return io_error(path, "cannot be read");
}

tl::unexpected<Error> strange(const fs::path& path, const Descriptor& file) {
  const bool folder = S_ISDIR(file.mode());
  return fail(ErrorCode::Io, path.string(),
              folder ? "is a folder" : "is a pipe, a device or a socket; a file is wanted");
}

/// Reads to the end.  At the other end of a pipe somebody has to write within some seconds.
Result<std::string> whole(const fs::path& path, const Descriptor& file, std::uintmax_t max_bytes) {
  std::string text;
  std::array<char, 1u << 16> piece{};
  if (S_ISFIFO(file.mode()) && !ready(file.get(), POLLIN))
    return io_error(path, "is a pipe to which nobody writes");
  while (true) {
    const ssize_t got = ::read(file.get(), piece.data(), piece.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN && ready(file.get(), POLLIN)) continue;
    if (got < 0) return io_error(path, "cannot be read");
    if (got == 0) return text;
    text.append(piece.data(), static_cast<std::size_t>(got));
    if (text.size() > max_bytes)
      return fail(ErrorCode::TooLarge, path.string(),
                  "has more than the " + std::to_string(max_bytes) + " bytes read at most");
  }
}

bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && (errno == EINTR || (errno == EAGAIN && ready(fd, POLLOUT)))) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

Result<void> write_into(const fs::path& path, std::string_view text) {
  // A pipe from which nobody reads is refused, and not waited for.
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file.get() < 0 || !write_all(file.get(), text)) return io_error(path, "cannot be written");
  return {};
}

Result<void> write_synced(const fs::path& path, std::string_view text, mode_t mode) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, mode));
  if (file.get() < 0) return io_error(path, "cannot be written");
  if (!write_all(file.get(), text) || ::fdatasync(file.get()) != 0 || !file.close())
    return io_error(path, "cannot be written to the end");
  return {};
}

}  // namespace

bool is_there(const fs::path& path) {
  struct stat about {};
  return ::lstat(path.c_str(), &about) == 0 || errno != ENOENT;
}

Result<std::string> read_file(const fs::path& path, std::uintmax_t max_bytes) {
  const auto file = opened(path);
  if (!file) return pass(file);
  if (!S_ISREG((*file)->mode())) return strange(path, **file);
  return whole(path, **file, max_bytes);
}

Result<std::string> read_file_or_pipe(const fs::path& path, std::uintmax_t max_bytes) {
  const auto file = opened(path);
  if (!file) return pass(file);
  const mode_t mode = (*file)->mode();
  if (!S_ISREG(mode) && !S_ISFIFO(mode) && !S_ISCHR(mode)) return strange(path, **file);
  return whole(path, **file, max_bytes);
}

Result<void> replace_file(const fs::path& path, std::string_view text) {
  constexpr mode_t kFresh = 0666;  // Before the user's umask is applied.
  constexpr mode_t kRights = 07777;
  struct stat before {};
  const bool there = ::stat(path.c_str(), &before) == 0;
  if (there && !S_ISREG(before.st_mode)) return write_into(path, text);
  std::error_code error;
  // A symbolic link stays; its target is replaced.
  const fs::path target = there ? fs::canonical(path, error) : path;
  if (error) return fail(ErrorCode::Io, path.string(), error.message());
  const fs::path partial = target.string() + ".partial";
  auto ok = write_synced(partial, text, kFresh);
  if (ok && there && ::chmod(partial.c_str(), before.st_mode & kRights) != 0)
    ok = io_error(partial, "cannot get the rights of the file it replaces");
  if (ok && ::rename(partial.c_str(), target.c_str()) != 0)
    ok = io_error(path, "cannot be replaced");
  if (!ok) {
    fs::remove(partial, error);
    return ok;
  }
  sync_folder(target.parent_path());
  return {};
}

void sync_folder(const fs::path& folder) {
  const fs::path named = folder.empty() ? fs::path(".") : folder;
  const Descriptor directory(::open(named.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() >= 0) (void)::fsync(directory.get());
}

}  // namespace chorus
