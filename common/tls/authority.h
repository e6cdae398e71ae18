// A small certificate authority for the hosts of a workshop, which no public authority knows.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "common/base/result.h"

namespace chorus::tls {

/// A certificate and its key, both in PEM; they belong to the authority or to a host.
struct Issued {
  std::string certificate;
  std::string key;
};

struct Validity {
  std::chrono::sys_seconds from;
  std::chrono::sys_seconds until;
};

/// From an hour ago, because the clocks of a workshop differ, until `days` days from now.
[[nodiscard]] Validity for_days(int days);

/// A new authority (elliptic curve P-256) that can sign hosts, but no further authorities.  `name`
/// is shown to people: "Chorus of hall 3".  InvalidArgument if it is empty or not UTF-8.
[[nodiscard]] Result<Issued> new_authority(const std::string& name, const Validity& validity);

/// A new key and a certificate for one host with these names and numeric addresses; the first is
/// its common name.  InvalidArgument for any other text, or if there is none; Malformed if
/// `authority` is not one.
[[nodiscard]] Result<Issued> new_certificate(const Issued& authority,
                                             const std::vector<std::string>& hosts,
                                             const Validity& validity);

}  // namespace chorus::tls
