// chorus init ca and chorus init certificate: an authority in a folder, and the certificates of
// hosts.
#pragma once

#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::ctl {

inline constexpr const char* kAuthorityFolder = "/etc/chorus/ca";
inline constexpr const char* kTlsFolder = "/etc/chorus/tls";

struct AuthorityWishes {
  std::string folder = kAuthorityFolder;
  std::string name;  ///< What browsers show.
  int days = 3650;
};

struct CertificateWishes {
  std::vector<std::string> hosts;  ///< Names and addresses; empty: of this host.
  std::string authority = kAuthorityFolder;
  std::string folder = kTlsFolder;
  bool renew = false;  ///< Overwrites.
  int days = 800;      ///< What browsers accept at most from an authority of one's own is 825.
};

/// Writes ca.crt for everybody and ca.key for the owner alone; never what is there already.
[[nodiscard]] Result<void> write_authority(const AuthorityWishes& wishes);

/// Writes host.crt, host.key and ca.crt for the services.  This host's own names for itself
/// (localhost, 127.0.0.1, ::1) are always among the certificate's.
[[nodiscard]] Result<void> write_certificate(const CertificateWishes& wishes);

}  // namespace chorus::ctl
