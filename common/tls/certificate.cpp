#include "common/tls/certificate.h"

#include <array>
#include <ctime>

#include <arpa/inet.h>
#include <openssl/x509v3.h>

#include "common/tls/openssl.h"

namespace chorus::tls {
namespace {

constexpr int kIpv4Bytes = 4;
constexpr int kIpv6Bytes = 16;

/// Untrusted text, made safe for a terminal.
std::string shown(const unsigned char* bytes, int size) {
  std::string text(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text;
}

std::string common_name(const X509_NAME* name) {
  const int at = X509_NAME_get_index_by_NID(name, NID_commonName, -1);
  if (at < 0) return {};
  const ASN1_STRING* const text = X509_NAME_ENTRY_get_data(X509_NAME_get_entry(name, at));
  return shown(ASN1_STRING_get0_data(text), ASN1_STRING_length(text));
}

std::chrono::sys_seconds time_of(const ASN1_TIME* time) {
  std::tm parts{};
  if (time == nullptr || ASN1_TIME_to_tm(time, &parts) != 1) return {};
  return std::chrono::sys_seconds(std::chrono::seconds(::timegm(&parts)));
}

std::string text_of(const GENERAL_NAME& name) {
  if (name.type == GEN_DNS)
    return shown(ASN1_STRING_get0_data(name.d.dNSName), ASN1_STRING_length(name.d.dNSName));
  if (name.type != GEN_IPADD) return {};
  const int size = ASN1_STRING_length(name.d.iPAddress);
  if (size != kIpv4Bytes && size != kIpv6Bytes) return {};
  std::array<char, INET6_ADDRSTRLEN> text{};
  ::inet_ntop(size == kIpv4Bytes ? AF_INET : AF_INET6, ASN1_STRING_get0_data(name.d.iPAddress),
              text.data(), text.size());
  return text.data();
}

std::vector<std::string> names_of(const X509& certificate) {
  std::vector<std::string> names;
  auto* const all = static_cast<GENERAL_NAMES*>(
      X509_get_ext_d2i(&certificate, NID_subject_alt_name, nullptr, nullptr));
  for (int i = 0; i < sk_GENERAL_NAME_num(all); ++i) {
    const std::string name = text_of(*sk_GENERAL_NAME_value(all, i));
    if (!name.empty()) names.push_back(name);
  }
  GENERAL_NAMES_free(all);
  return names;
}

}  // namespace

CertificateFacts facts_of(const x509_st& certificate) {
  return {common_name(X509_get_subject_name(&certificate)),
          common_name(X509_get_issuer_name(&certificate)), names_of(certificate),
          time_of(X509_get0_notBefore(&certificate)), time_of(X509_get0_notAfter(&certificate))};
}

Result<CertificateFacts> facts_of(std::string_view pem) {
  const auto all = certificates_in(pem);
  if (all.empty()) {
    return fail(ErrorCode::Malformed, "certificate",
                "holds no certificate; PEM is needed (-----BEGIN CERTIFICATE-----)");
  }
  return facts_of(*all.front());
}

std::string date_text(std::chrono::sys_seconds time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  std::array<char, 16> text{};
  (void)std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts);
  return text.data();
}

}  // namespace chorus::tls
