#include "fusion-server/server/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/base/file.h"
#include "common/base/shipped_folder.h"

namespace chorus::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kAdvice =
    "; give it to the user of the service (chown), or name another folder";

}  // namespace

std::string state_folder(std::string_view configured, std::uint16_t port,
                         const Environment& environment) {
  if (configured != "auto") return std::string(configured);
  const std::string given = value_of(environment, "STATE_DIRECTORY");
  if (!given.empty()) return given.substr(0, given.find(':'));
  if (port == 0) return {};
  const std::string own = "chorus/fusion-" + std::to_string(port);
  // The XDG base directory specification says that relative paths must be ignored.
  const fs::path state = value_of(environment, "XDG_STATE_HOME");
  if (state.is_absolute()) return (state / own).string();
  const fs::path home = value_of(environment, "HOME");
  return home.is_absolute() ? (home / ".local/state" / own).string() : std::string();
}

Result<void> probe_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return fail(ErrorCode::Io, folder,
                "cannot be created: " + error.message() + std::string(kAdvice));
  const fs::path probe = fs::path(folder) / ".probe";
  if (auto written = replace_file(probe, "probe\n"); !written) {
    return fail(ErrorCode::Io, folder,
                "cannot be written to: " + written.error().message + std::string(kAdvice));
  }
  fs::remove(probe, error);
  return {};
}

Result<StateClaim> StateClaim::take(const std::string& folder) {
  if (folder.empty()) return StateClaim();
  constexpr mode_t kMode = 0644;
  const std::string path = (fs::path(folder) / ".lock").string();
  const int lock = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kMode);
  if (lock < 0) return StateClaim();
  StateClaim claim(lock);
  if (::flock(lock, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return claim;
  return fail(ErrorCode::Conflict, folder,
              "another chorus-fusion keeps its state there; end it, or set state_dir to another "
              "folder");
}

StateClaim& StateClaim::operator=(StateClaim&& other) noexcept {
  std::swap(lock_, other.lock_);
  return *this;
}

StateClaim::~StateClaim() {
  if (lock_ >= 0) ::close(lock_);
}

std::string viewer_folder(const std::string& configured) {
  if (configured != "auto") return configured;
  auto shipped = shipped_folder("viewer", "index.html");
  return shipped ? std::move(*shipped) : std::string();
}

Result<void> probe_viewer(const std::string& folder) {
  if (folder.empty()) {
    return fail(ErrorCode::NotFound, "viewer_dir",
                "there is no index.html in ../share/chorus/viewer or ../../../services/viewer "
                "beside the program, nor in services/viewer here: set viewer_dir to the folder of "
                "the viewer, or to \"\"");
  }
  std::error_code ignored;
  if (!fs::exists(fs::path(folder) / "index.html", ignored)) {
    return fail(ErrorCode::NotFound, folder,
                "has no index.html: set viewer_dir to services/viewer of the sources (relative to "
                "where the server is started), or to \"\"");
  }
  if (!fs::exists(fs::path(folder) / "node_modules/three", ignored)) {
    return fail(ErrorCode::NotFound, folder,
                "lacks three.js, so the viewer cannot draw: npm ci --prefix " + folder);
  }
  return {};
}

}  // namespace chorus::server
