#include "common/service/configuration.h"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/service/waiting_keys.h"

namespace chorus::service {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kHidden = "(hidden)";
constexpr const char* kPath = "(a path of this host)";
constexpr std::array<std::string_view, 5> kSecretKeys{"token", "bearer_token", "password", "secret",
                                                      "passphrase"};

bool is_secret(std::string_view key) {
  return std::ranges::find(kSecretKeys, key) != kSecretKeys.end();
}

/// "http://user:pass@host/" -> "http://host/".
std::string without_user(const std::string& url) {
  const std::size_t scheme = url.find("://");
  if (scheme == std::string::npos) return url;
  const std::size_t begin = scheme + 3;
  const std::size_t at = url.find('@', begin);
  if (at == std::string::npos || at > url.find('/', begin)) return url;
  return url.substr(0, begin) + url.substr(at + 1);
}

void hide(json& value, std::string_view key) {
  if (value.is_string()) {
    const std::string text = value.get<std::string>();
    if (is_secret(key) && !text.empty()) {
      value = kHidden;
    } else if (text.starts_with('/')) {
      value = kPath;
    } else {
      value = without_user(text);
    }
  } else if (value.is_object()) {
    for (auto& [name, member] : value.items()) hide(member, name);
  } else if (value.is_array()) {
    for (json& item : value) hide(item, key);
  }
}

/// The text, in which the file's path is only its name.
std::string without_folder(std::string text, const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  if (path.empty() || name == path) return text;
  for (std::size_t at = text.find(path); at != std::string::npos; at = text.find(path, at))
    text.replace(at, path.size(), name);
  return text;
}

std::string listed(const std::vector<std::string>& keys) {
  std::string text;
  for (const std::string& key : keys) text += (text.empty() ? "" : ", ") + key;
  return text;
}

}  // namespace

void Configuration::started(ConfigSource source, std::string text, Timestamp now) {
  const std::scoped_lock lock(mutex_);
  source_ = std::move(source);
  started_as_ = text;
  text_ = std::move(text);
  read_ = now;
  disk_.reset();
}

void Configuration::reload_failed(const Error& error, Timestamp now) {
  const std::scoped_lock lock(mutex_);
  reload_error_ = to_string(error);
  reloaded_ = now;
}

void Configuration::reloaded(std::string text, std::vector<std::string> waiting, Timestamp now) {
  const std::scoped_lock lock(mutex_);
  text_ = std::move(text);
  waiting_ = std::move(waiting);
  reload_error_.clear();
  reloaded_ = read_ = now;
  disk_.reset();
}

void Configuration::look_at_disk() const {
  std::error_code failed;
  if (source_.path.empty()) return;
  const bool file = fs::is_regular_file(source_.path, failed);
  if (!file && fs::exists(source_.path, failed)) return;  // A pipe has nothing more to say.
  const auto modified = file ? fs::last_write_time(source_.path, failed) : fs::file_time_type{};
  if (disk_ && disk_->modified == modified && !failed) return;
  disk_ = Disk{modified, {}, {}};
  auto now = read_config(source_);
  if (now) {
    disk_->changed = changed_keys(text_, now->text());
  } else {
    disk_->error = to_string(now.error());
  }
}

ConfigurationFacts Configuration::facts() const {
  const std::scoped_lock lock(mutex_);
  look_at_disk();
  ConfigurationFacts facts;
  facts.file = fs::path(source_.path).filename().string();
  facts.in_force = without_secrets(with_keys_of(text_, started_as_, waiting_));
  facts.read = read_;
  facts.waiting = waiting_;
  facts.reload_error = without_folder(reload_error_, source_.path);
  facts.reloaded = reloaded_;
  if (!disk_) return facts;
  facts.changed_on_disk = disk_->changed;
  facts.disk_error = without_folder(disk_->error, source_.path);
  return facts;
}

std::string Configuration::trouble() const {
  const std::scoped_lock lock(mutex_);
  if (!reload_error_.empty())
    return "the configuration was not reloaded, and the old one stays: " +
           without_folder(reload_error_, source_.path);
  if (waiting_.empty()) return {};
  return "these keys were changed and wait for a restart: " + listed(waiting_);
}

std::string without_secrets(const std::string& text) {
  json parsed = json::parse(text, nullptr, false);
  if (parsed.is_discarded()) return "{}";
  hide(parsed, "");
  return parsed.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string configuration_json(const ConfigurationFacts& facts) {
  json out{{"file", facts.file},
           {"read", to_iso8601(facts.read)},
           {"pendingRestart", facts.waiting},
           {"changedOnDisk", facts.changed_on_disk},
           {"inForce", json::parse(facts.in_force, nullptr, false)}};
  if (out["inForce"].is_discarded()) out["inForce"] = json::object();
  if (facts.reloaded) out["lastReload"] = to_iso8601(*facts.reloaded);
  if (!facts.reload_error.empty()) out["lastReloadError"] = facts.reload_error;
  if (!facts.disk_error.empty()) out["onDiskError"] = facts.disk_error;
  return out.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace chorus::service
