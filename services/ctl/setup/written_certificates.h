// For chorus init ca and chorus init certificate: an authority in a folder, and certificates for
// hosts.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"
#include "common/client/service_client.h"

namespace chorus::ctl {

inline constexpr const char* kAuthorityFolder = "/etc/chorus/ca";

struct AuthorityWishes {
  std::string folder = kAuthorityFolder;
  std::string name;  ///< The name that browsers show.
  int days = 3650;
};

struct CertificateWishes {
  std::vector<std::string> hosts;  ///< Names and addresses; empty: those of this host.
  std::string authority = kAuthorityFolder;
  std::string folder = client::kTlsFolder;
  bool renew = false;  ///< Overwrite the present one.
  int days = 800;      ///< Browsers accept at most 825 from a private authority.
};

/// The command that makes a certificate with the authority in `folder`.
[[nodiscard]] std::string next_certificate(const std::string& folder);

/// Writes ca.crt, which everybody may read, and ca.key for the owner only; never overwrites them.
[[nodiscard]] Result<void> write_authority(const AuthorityWishes& wishes);

/// Writes host.crt, host.key and ca.crt for the services.  The certificate always contains this
/// host's own names for itself (localhost, 127.0.0.1, ::1).
[[nodiscard]] Result<void> write_certificate(const CertificateWishes& wishes);

}  // namespace chorus::ctl
