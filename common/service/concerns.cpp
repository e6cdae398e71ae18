#include "common/service/concerns.h"

#include <unistd.h>

#include <filesystem>
#include <string>
#include <system_error>

#include "common/base/log.h"
#include "common/net/asio.h"
#include "common/net/listen.h"
#include "common/tls/certificate.h"

namespace chorus::service {
namespace {

namespace fs = std::filesystem;

/// The folder itself, or the nearest of its parents that exists.
fs::path nearest_existing(fs::path folder) {
  std::error_code ignored;
  while (!fs::exists(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

/// Creates a folder in `folder` and removes it again, because permissions alone do not say whether
/// that is possible: those of /proc let root write, but nothing can be created there.
std::error_code try_folder(const fs::path& folder) {
  const fs::path probe = folder / (".chorus-probe-" + std::to_string(::getpid()));
  std::error_code error;
  fs::create_directory(probe, error);
  std::error_code ignored;
  if (!error) fs::remove(probe, ignored);
  return error;
}

std::chrono::sys_seconds present() {
  return std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
}

}  // namespace

Result<void> usable_folder(const std::string& folder) {
  const fs::path there = nearest_existing(folder);
  std::error_code ignored;
  if (!fs::is_directory(there, ignored))
    return fail(ErrorCode::Io, folder, there.string() + " is no folder");
  const std::error_code refused = try_folder(there);
  if (!refused) return {};
  const std::string what =
      there == fs::path(folder) ? "cannot be written to" : "cannot be created in " + there.string();
  return fail(ErrorCode::Io, folder,
              what + " by this user (" + refused.message() +
                  "); give it to the user of the service (chown), or name another");
}

Result<void> free_to_listen(const http::ServerConfig& config) {
  if (config.port == 0) return {};
  asio::io_context io;
  net::Acceptor acceptor(io);
  return net::listen_on(acceptor, {config.address, config.port, "http.port"});
}

std::optional<std::string> clock_concern(const NtpStatus& clock) {
  if (clock.synchronised) return std::nullopt;
  return "the clock of this host is not synchronised, and bodies are fused by the time they were "
         "seen: install chrony (apt install chrony), or let it finish";
}

std::optional<std::string> certificate_concern(const http::ServerConfig& config,
                                               std::chrono::sys_seconds now) {
  if (!config.identity) return std::nullopt;
  const auto facts = tls::facts_of(config.identity->certificate());
  if (!facts || (now >= facts->not_before && now <= facts->not_after)) return std::nullopt;
  if (now < facts->not_before)
    return "http.tls.certificate is not good before " + tls::date_text(facts->not_before) +
           ": set the clock of this host";
  return "http.tls.certificate has expired on " + tls::date_text(facts->not_after) +
         ", so nobody connects: chorus init certificate NAMES --renew where the authority is, copy "
         "it here, and reload this service";
}

Concerns common_concerns(const http::ServerConfig& http, const RecordingConfig& recording) {
  Concerns all;
  if (const auto free = free_to_listen(http); !free) all.push_back(to_string(free.error()));
  if (auto expired = certificate_concern(http, present())) all.push_back(std::move(*expired));
  if (!recording.folder.empty()) {
    if (const auto usable = usable_folder(recording.folder); !usable)
      all.push_back("nothing can be recorded: " + to_string(usable.error()));
  }
  if (auto clock = clock_concern(read_ntp_status())) all.push_back(std::move(*clock));
  return all;
}

void log_concerns(const http::ServerConfig& http, const RecordingConfig& recording) {
  if (const auto expired = certificate_concern(http, present()))
    log::error("programs will not connect", {{"reason", *expired}});
  if (!recording.folder.empty()) {
    if (const auto usable = usable_folder(recording.folder); !usable)
      log::error("nothing can be recorded", {{"reason", to_string(usable.error())}});
  }
  if (const auto clock = clock_concern(read_ntp_status()))
    log::warn("clock not synchronised", {{"advice", *clock}});
}

}  // namespace chorus::service
