// The facts in a certificate.
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"

struct x509_st;

namespace chorus::tls {

/// Texts can be shown on a terminal: "?" replaces every byte that is not printable ASCII.
struct CertificateFacts {
  std::string subject;             ///< Its common name.
  std::string issuer;              ///< Common name of the signer.
  std::vector<std::string> names;  ///< Its hosts: "sensor-1.local", "10.0.0.11".
  std::chrono::sys_seconds not_before{};
  std::chrono::sys_seconds not_after{};
};

[[nodiscard]] CertificateFacts facts_of(const x509_st& certificate);

/// Facts of the first certificate in a PEM text; Malformed when there is none.
[[nodiscard]] Result<CertificateFacts> facts_of(std::string_view pem);

/// "2026-11-22"
[[nodiscard]] std::string date_text(std::chrono::sys_seconds time);

}  // namespace chorus::tls
