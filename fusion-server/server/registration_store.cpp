#include "fusion-server/server/registration_store.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "fusion-server/publish/registration_file.h"

namespace chorus::server {
namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> io_error(const std::string& path, const std::string& what) {
  return fail(ErrorCode::Io, path, what + ": " + std::strerror(errno));
}

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

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

Result<void> write_synced(const std::string& path, std::string_view text) {
  constexpr mode_t kMode = 0644;
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode));
  if (file.get() < 0) return io_error(path, "cannot be written");
  if (!write_all(file.get(), text) || ::fsync(file.get()) != 0) {
    return io_error(path, "cannot be written to the end");
  }
  return {};
}

void sync_folder(const std::string& folder) {
  const Descriptor directory(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.get() >= 0) ::fsync(directory.get());
}

}  // namespace

std::string RegistrationStore::path() const { return folder_ + "/registration.json"; }

Result<std::optional<Registration>> RegistrationStore::load() const {
  std::error_code ignored;
  if (folder_.empty() || !fs::exists(path(), ignored)) return std::nullopt;
  auto registration = load_registration_file(path());
  if (!registration) return pass(registration);
  return std::optional(std::move(*registration));
}

Result<void> RegistrationStore::save(const Registration& registration) const {
  if (folder_.empty()) return {};
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return fail(ErrorCode::Io, folder_, "cannot be created: " + error.message());
  const std::string temporary = path() + ".new";
  if (auto ok = write_synced(temporary, publish::write_registration(registration)); !ok) return ok;
  if (std::rename(temporary.c_str(), path().c_str()) != 0) {
    return io_error(path(), "cannot be replaced");
  }
  sync_folder(folder_);
  return {};
}

Result<void> RegistrationStore::forget() const {
  std::error_code error;
  if (folder_.empty() || !fs::exists(path(), error)) return {};
  fs::rename(path(), path() + ".old", error);
  if (error) return fail(ErrorCode::Io, path(), "cannot be moved aside: " + error.message());
  sync_folder(folder_);
  return {};
}

Result<Registration> load_registration_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  if (!file || !(text << file.rdbuf())) return fail(ErrorCode::Io, path, "cannot be read");
  auto registration = publish::read_registration(text.str());
  if (!registration) {
    return fail(registration.error().code, path, to_string(registration.error()));
  }
  return registration;
}

}  // namespace chorus::server
