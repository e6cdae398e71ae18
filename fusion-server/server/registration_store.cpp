#include "fusion-server/server/registration_store.h"

#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/base/file.h"
#include "fusion-server/wire/registration_file.h"

namespace chorus::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostBytes = 16u << 20;

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
  return replace_file(path(), wire::write_registration(registration));
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
  const auto text = read_file(path, kMostBytes);
  if (!text) return fail(ErrorCode::Io, path, "cannot be read: " + text.error().message);
  auto registration = wire::read_registration(*text);
  if (!registration) {
    return fail(registration.error().code, path, to_string(registration.error()));
  }
  return registration;
}

}  // namespace chorus::server
