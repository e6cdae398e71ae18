#include "common/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
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
  [[nodiscard]] bool close() {
    const int fd = std::exchange(fd_, -1);
    return fd < 0 || ::close(fd) == 0;
  }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

Result<void> write_into(const fs::path& path, std::string_view text) {
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
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

Result<std::string> read_file(const fs::path& path, std::uintmax_t max_bytes) {
  std::error_code error;
  if (fs::is_directory(path, error)) return fail(ErrorCode::Io, path.string(), "is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    const bool there = fs::exists(path, error);
    return fail(there ? ErrorCode::Io : ErrorCode::NotFound, path.string(),
                there ? "cannot be read" : "there is no such file");
  }
  std::string text;
  std::array<char, 1u << 16> piece{};
  while (in.read(piece.data(), piece.size()) || in.gcount() > 0) {
    text.append(piece.data(), static_cast<std::size_t>(in.gcount()));
    if (text.size() > max_bytes) {
      return fail(ErrorCode::TooLarge, path.string(),
                  "has more than the " + std::to_string(max_bytes) + " bytes read at most");
    }
  }
  if (in.bad()) return fail(ErrorCode::Io, path.string(), "cannot be read");
  return text;
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
