#include "common/tls/authority.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include <arpa/inet.h>
#include <openssl/asn1.h>
#include <openssl/ec.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>

#include "common/tls/openssl.h"

namespace chorus::tls {
namespace {

constexpr int kSerialBits = 127;
constexpr std::size_t kLongestName = 253;

/// For OpenSSL calls that fail only for lack of memory or randomness.
void need(bool done) {
  if (!done) throw std::runtime_error("making a certificate failed: " + last_reason());
}

bool is_address(const std::string& host) {
  unsigned char bytes[16];
  return ::inet_pton(AF_INET, host.c_str(), bytes) == 1 ||
         ::inet_pton(AF_INET6, host.c_str(), bytes) == 1;
}

bool is_name(const std::string& host) {
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '.' || c == '_';
  };
  const auto counts = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  // 10.0.0.300 is an address with a slip: no name ends in digits alone.
  if (std::all_of(host.begin(), host.end(), counts)) return false;
  return !host.empty() && host.size() <= kLongestName && host.front() != '-' &&
         host.front() != '.' && std::all_of(host.begin(), host.end(), fits);
}

/// The first 64 characters, as many as a common name may have; none if the text is not UTF-8.
std::optional<std::string> common_name_of(const std::string& name) {
  constexpr int kLongestCommonName = 64;  // ub-common-name of RFC 5280
  const auto* const bytes = reinterpret_cast<const unsigned char*>(name.data());
  const auto size = static_cast<int>(name.size());
  int begin = 0;
  int end = 0;
  for (int characters = 0; begin < size; ++characters) {
    unsigned long ignored = 0;
    const int taken = UTF8_getc(bytes + begin, size - begin, &ignored);
    if (taken <= 0) return std::nullopt;
    begin += taken;
    if (characters < kLongestCommonName) end = begin;
  }
  return name.substr(0, static_cast<std::size_t>(end));
}

std::string pem_of(X509* certificate) {
  const Owned<BIO> out(BIO_new(BIO_s_mem()));
  need(out && PEM_write_bio_X509(out.get(), certificate) == 1);
  char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

std::string pem_of(EVP_PKEY* key) {
  const Owned<BIO> out(BIO_new(BIO_s_mem()));
  need(out &&
       PEM_write_bio_PKCS8PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1);
  char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

void set_serial(X509* certificate) {
  BIGNUM* const number = BN_new();
  need(number != nullptr && BN_rand(number, kSerialBits, BN_RAND_TOP_ANY, BN_RAND_BOTTOM_ANY) == 1);
  BN_to_ASN1_INTEGER(number, X509_get_serialNumber(certificate));
  BN_free(number);
}

/// A certificate with a key and times that is not yet signed.
Owned<X509> unsigned_certificate(const std::string& common_name, EVP_PKEY* key,
                                 const Validity& validity) {
  Owned<X509> certificate(X509_new());
  need(certificate && X509_set_version(certificate.get(), X509_VERSION_3) == 1);
  set_serial(certificate.get());
  const auto time = [](std::chrono::sys_seconds at) {
    return std::chrono::system_clock::to_time_t(at);
  };
  need(ASN1_TIME_set(X509_getm_notBefore(certificate.get()), time(validity.from)) != nullptr);
  need(ASN1_TIME_set(X509_getm_notAfter(certificate.get()), time(validity.until)) != nullptr);
  need(X509_set_pubkey(certificate.get(), key) == 1);
  need(X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate.get()), "CN", MBSTRING_UTF8,
                                  reinterpret_cast<const unsigned char*>(common_name.c_str()), -1,
                                  -1, 0) == 1);
  return certificate;
}

void extend(X509* certificate, X509* issuer, int what, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* const extension =
      X509V3_EXT_conf_nid(nullptr, &context, what, const_cast<char*>(value.c_str()));
  need(extension != nullptr);
  X509_add_ext(certificate, extension, -1);
  X509_EXTENSION_free(extension);
}

Issued signed_by(EVP_PKEY* signer, X509* certificate, EVP_PKEY* key) {
  need(X509_sign(certificate, signer, EVP_sha256()) > 0);
  return {pem_of(certificate), pem_of(key)};
}

}  // namespace

Validity for_days(int days) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  return {now - std::chrono::hours(1), now + std::chrono::hours(24) * days};
}

Result<Issued> new_authority(const std::string& name, const Validity& validity) {
  if (name.empty()) return fail(ErrorCode::InvalidArgument, "name", "an authority needs a name");
  const auto common_name = common_name_of(name);
  if (!common_name) return fail(ErrorCode::InvalidArgument, "name", "must be UTF-8");
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"));
  need(key != nullptr);
  const auto certificate = unsigned_certificate(*common_name, key.get(), validity);
  X509* const own = certificate.get();
  need(X509_set_issuer_name(own, X509_get_subject_name(own)) == 1);
  extend(own, own, NID_basic_constraints, "critical,CA:TRUE,pathlen:0");
  extend(own, own, NID_key_usage, "critical,keyCertSign,cRLSign");
  extend(own, own, NID_subject_key_identifier, "hash");
  return signed_by(key.get(), own, key.get());
}

Result<Issued> new_certificate(const Issued& authority, const std::vector<std::string>& hosts,
                               const Validity& validity) {
  const auto issuers = certificates_in(authority.certificate);
  const auto signer = key_in(authority.key);
  if (issuers.empty() || !signer ||
      X509_check_private_key(issuers.front().get(), signer.get()) != 1) {
    (void)last_reason();
    return fail(ErrorCode::Malformed, "authority",
                "is no certificate with its private key; `chorus init ca` makes one");
  }
  if (hosts.empty()) return fail(ErrorCode::InvalidArgument, "hosts", "name a host at least");
  std::string alternatives;
  for (const std::string& host : hosts) {
    const bool address = is_address(host);
    if (!address && !is_name(host)) {
      return fail(ErrorCode::InvalidArgument, host,
                  "is neither a host's name nor a numeric address, such as sensor-1.local or "
                  "10.0.0.11");
    }
    alternatives +=
        (alternatives.empty() ? "" : ",") + std::string(address ? "IP:" : "DNS:") + host;
  }
  const Owned<EVP_PKEY> key(EVP_EC_gen("P-256"));
  need(key != nullptr);
  const auto certificate =
      unsigned_certificate(common_name_of(hosts.front()).value_or(""), key.get(), validity);
  X509* const own = certificate.get();
  X509* const issuer = issuers.front().get();
  need(X509_set_issuer_name(own, X509_get_subject_name(issuer)) == 1);
  extend(own, issuer, NID_basic_constraints, "critical,CA:FALSE");
  extend(own, issuer, NID_key_usage, "critical,digitalSignature");
  extend(own, issuer, NID_ext_key_usage, "serverAuth");
  extend(own, issuer, NID_subject_key_identifier, "hash");
  extend(own, issuer, NID_authority_key_identifier, "keyid");
  extend(own, issuer, NID_subject_alt_name, alternatives);
  return signed_by(signer.get(), own, key.get());
}

}  // namespace chorus::tls
