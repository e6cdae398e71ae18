// A certificate authority for tests, and hosts with its certificates.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/tls/authority.h"
#include "common/tls/credentials.h"

namespace chorus::testing {

class WorkshopAuthority {
 public:
  [[nodiscard]] tls::Issued issue(const std::vector<std::string>& hosts, int days = 30) const {
    return tls::new_certificate(authority_, hosts, tls::for_days(days)).value();
  }
  /// A certificate that expired a day ago.
  [[nodiscard]] tls::Issued issue_expired(const std::vector<std::string>& hosts) const {
    using std::chrono::hours;
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    return tls::new_certificate(authority_, hosts, {now - hours(48), now - hours(24)}).value();
  }
  [[nodiscard]] tls::Identity identity(const std::vector<std::string>& hosts = {
                                           "localhost", "127.0.0.1"}) const {
    const tls::Issued issued = issue(hosts);
    return tls::Identity::of(issued.certificate, issued.key).value();
  }
  [[nodiscard]] tls::Trust trust() const {
    return tls::Trust::of(authority_.certificate, "ca.crt").value();
  }
  [[nodiscard]] const tls::Issued& files() const { return authority_; }

 private:
  tls::Issued authority_ = tls::new_authority("Test workshop", tls::for_days(30)).value();
};

}  // namespace chorus::testing
