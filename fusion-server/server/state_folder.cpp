#include "fusion-server/server/state_folder.h"

#include <filesystem>
#include <system_error>

#include "common/base/file.h"

namespace chorus::server {
namespace {

namespace fs = std::filesystem;

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
  if (error) return fail(ErrorCode::Io, folder, "cannot be created: " + error.message());
  const fs::path probe = fs::path(folder) / ".probe";
  if (auto written = replace_file(probe, "probe\n"); !written) {
    return fail(ErrorCode::Io, folder, "cannot be written to: " + written.error().message);
  }
  fs::remove(probe, error);
  return {};
}

Result<void> probe_viewer(const std::string& folder) {
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
