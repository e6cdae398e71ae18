#include "services/ctl/setup/written_certificates.h"

#include <algorithm>

#include "common/base/file.h"
#include "common/http/access.h"
#include "common/tls/authority.h"
#include "services/ctl/line/new_file.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMaxBytes = 1u << 16;

std::vector<std::string> names_for(std::vector<std::string> hosts) {
  if (hosts.empty()) hosts = http::host_names();
  for (const char* const own : {"localhost", "127.0.0.1", "::1"}) {
    if (std::find(hosts.begin(), hosts.end(), own) == hosts.end()) hosts.emplace_back(own);
  }
  return hosts;
}

Result<std::string> of_authority(const std::string& folder, const std::string& name) {
  auto text = read_file(folder + "/" + name, kMaxBytes);
  if (text) return text;
  return fail(text.error().code, folder + "/" + name,
              text.error().message +
                  "; run this where `chorus init ca` was run, as the same user, or name that "
                  "folder with --authority");
}

}  // namespace

std::string next_certificate(const std::string& folder) {
  const std::string command = "chorus init certificate HOST ADDRESS";
  return folder == kAuthorityFolder ? command : command + " --authority " + folder;
}

Result<void> write_authority(const AuthorityWishes& wishes) {
  const auto issued = tls::new_authority(wishes.name.empty() ? "Chorus workshop" : wishes.name,
                                         tls::for_days(wishes.days));
  if (!issued) return pass(issued);
  if (auto ok = make_folder(wishes.folder, Readers::Owner); !ok) return ok;
  // The key is written first: a certificate without its key would look like an authority without
  // being one.
  if (auto ok = write_file(wishes.folder + "/ca.key", issued->key, Readers::Owner); !ok) {
    if (ok.error().code == ErrorCode::InvalidArgument)
      ok.error().message =
          "exists: this authority is made already, and is not made anew, because hosts trust it.  "
          "Go on with " +
          next_certificate(wishes.folder) + "; --out FOLDER makes another authority";
    return ok;
  }
  return write_file(wishes.folder + "/ca.crt", issued->certificate, Readers::Everybody);
}

Result<void> write_certificate(const CertificateWishes& wishes) {
  const auto certificate = of_authority(wishes.authority, "ca.crt");
  if (!certificate) return pass(certificate);
  const auto key = of_authority(wishes.authority, "ca.key");
  if (!key) return pass(key);
  const auto issued = tls::new_certificate({*certificate, *key}, names_for(wishes.hosts),
                                           tls::for_days(wishes.days));
  if (!issued) return pass(issued);
  if (auto ok = make_folder(wishes.folder, Readers::Services); !ok) return ok;
  const auto overwriting = wishes.renew ? Overwriting::Yes : Overwriting::Never;
  const auto write = [&](const char* name, const std::string& text, Readers readers) {
    return write_file(wishes.folder + "/" + name, text, readers, overwriting);
  };
  if (auto ok = write("host.key", issued->key, Readers::Services); !ok) {
    if (ok.error().code == ErrorCode::InvalidArgument)
      ok.error().message = "exists; --renew replaces it and host.crt, --out FOLDER keeps both";
    return ok;
  }
  if (auto ok = write("host.crt", issued->certificate, Readers::Everybody); !ok) return ok;
  return write_file(wishes.folder + "/ca.crt", *certificate, Readers::Everybody, Overwriting::Yes);
}

}  // namespace chorus::ctl
