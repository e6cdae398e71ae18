#include "services/ctl/setup/init_checks.h"

#include <algorithm>
#include <cstdint>
#include <iostream>
#include <set>

#include "common/base/file.h"
#include "common/client/service_client.h"
#include "common/net/asio.h"
#include "common/service/http_config.h"
#include "common/tls/certificate.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMaxCertificate = 1u << 16;

bool of_this_host_alone(const std::string& name) {
  return name == "localhost" || name == "::1" || name.starts_with("127.");
}

}  // namespace

Result<void> check_service(const std::string& address, const std::string& token) {
  boost::system::error_code failed;
  asio::ip::make_address(address, failed);
  if (failed) {
    return fail(ErrorCode::InvalidArgument, "--listen",
                "\"" + address +
                    "\" is no numeric address: 127.0.0.1 is this host alone, 0.0.0.0 the whole "
                    "network");
  }
  if (!token.empty() && token.size() < service::kShortestToken) {
    return fail(ErrorCode::InvalidArgument, "--token",
                "needs at least 12 characters, such as `openssl rand -hex 16` makes; without it "
                "one is made");
  }
  return {};
}

Result<void> check_names(const std::vector<PolledWish>& sensors) {
  std::set<std::string> names;
  for (const PolledWish& sensor : sensors) {
    if (!names.insert(sensor.id).second)
      return fail(ErrorCode::InvalidArgument, sensor.id,
                  "is named twice; each sensor has an id "
                  "of its own");
  }
  return {};
}

std::string certificate_note(const std::string& tls_folder) {
  if (tls_folder.empty() || client::host_has_tls(tls_folder)) return {};
  return "but now, there is no " + tls_folder +
         "/host.crt, without which it does not start: chorus init certificate --out " + tls_folder +
         "\n";
}

std::string certified_name(const std::string& tls_folder, const std::string& own) {
  const auto pem = read_file(tls_folder + "/host.crt", kMaxCertificate);
  if (!pem) return own;
  const auto facts = tls::facts_of(*pem);
  if (!facts || std::ranges::find(facts->names, own) != facts->names.end()) return own;
  const auto other = std::ranges::find_if_not(facts->names, of_this_host_alone);
  return other == facts->names.end() ? own : *other;
}

Result<int> told_as_usage(std::string_view command, Result<int> done) {
  if (done) return done;
  const ErrorCode code = done.error().code;
  if (code != ErrorCode::InvalidArgument && code != ErrorCode::Malformed) return done;
  std::cerr << command << ": " << printable(to_string(done.error())) << '\n';
  return kExitUsage;
}

}  // namespace chorus::ctl
