#include "fusion-server/server/registration_store.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/file.h"
#include "common/base/json.h"
#include "fusion-server/wire/registration_file.h"

namespace chorus::server {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxBytes = 16u << 20;
// The largest integer that every JSON reader represents exactly.
constexpr std::uint64_t kMaxPeople = 1ULL << 53U;

}  // namespace

std::string RegistrationStore::path() const { return folder_ + "/registration.json"; }

std::string RegistrationStore::people_path() const { return folder_ + "/people.json"; }

Result<std::optional<Registration>> RegistrationStore::load() const {
  if (folder_.empty() || !is_there(path())) return std::nullopt;
  auto registration = load_registration_file(path());
  if (!registration) return pass(registration);
  return std::optional(std::move(*registration));
}

Recovered RegistrationStore::recover(const Error& damage) const {
  fs::path aside = path() + ".damaged";
  std::error_code error;
  for (int i = 2; is_there(aside); ++i) aside = path() + ".damaged-" + std::to_string(i);
  fs::rename(path(), aside, error);
  Recovered out{load_earlier(), "the stored registration cannot be read: " + to_string(damage)};
  out.told += error ? "; it cannot be moved aside: " + error.message()
                    : "; it is kept as " + aside.filename().string();
  if (!out.registration) {
    out.told += ", and there is none from before: the sensors have to be registered anew";
    return out;
  }
  out.told += ", and the one from before it is in use (registration.json.old)";
  if (!error) fs::rename(path() + ".old", path(), error);
  sync_folder(folder_);
  return out;
}

Result<void> RegistrationStore::write(const std::string& file, const std::string& text) const {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return fail(ErrorCode::Io, folder_, "cannot be created: " + error.message());
  return replace_file(file, text);
}

std::optional<Registration> RegistrationStore::load_earlier() const {
  if (folder_.empty() || !is_there(path() + ".old")) return std::nullopt;
  auto earlier = load_registration_file(path() + ".old");
  if (!earlier) return std::nullopt;
  return std::move(*earlier);
}

Result<void> RegistrationStore::save(const Registration& registration,
                                     const std::optional<Registration>& earlier) const {
  if (folder_.empty()) return {};
  if (earlier) {
    if (auto done = write(path() + ".old", wire::write_registration(*earlier)); !done) return done;
  }
  return write(path(), wire::write_registration(registration));
}

Result<std::uint64_t> RegistrationStore::load_next_person() const {
  if (folder_.empty() || !is_there(people_path())) return 1;
  const auto text = read_file(people_path(), kMaxBytes);
  if (!text) return pass(text);
  const auto json = parse_json(*text).value_or(nlohmann::json());
  const auto next = json.is_object() ? json.find("nextPerson") : json.end();
  const bool known = json.is_object() && next != json.end() && next->is_number_unsigned();
  if (!known || next->get<std::uint64_t>() > kMaxPeople)
    return fail(ErrorCode::Malformed, people_path(), "{\"nextPerson\": NUMBER} is wanted");
  return std::max<std::uint64_t>(1, next->get<std::uint64_t>());
}

Result<void> RegistrationStore::save_next_person(std::uint64_t next) const {
  if (folder_.empty()) return {};
  return write(people_path(), nlohmann::json{{"nextPerson", next}}.dump() + "\n");
}

Result<void> RegistrationStore::forget() const {
  std::error_code error;
  if (folder_.empty() || !is_there(path())) return {};
  fs::rename(path(), path() + ".old", error);
  if (error) return fail(ErrorCode::Io, path(), "cannot be moved aside: " + error.message());
  sync_folder(folder_);
  return {};
}

Result<Registration> load_registration_file(const std::string& path) {
  const auto text = read_file(path, kMaxBytes);
  if (!text) return fail(ErrorCode::Io, path, "cannot be read: " + text.error().message);
  auto registration = wire::read_registration(*text);
  if (!registration) {
    return fail(registration.error().code, path, to_string(registration.error()));
  }
  return registration;
}

}  // namespace chorus::server
