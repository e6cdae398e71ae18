// The OpenSSL helpers that the files of common/tls share; nothing else includes them.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>

namespace chorus::tls {

struct Freeing {
  void operator()(BIO* it) const { BIO_free_all(it); }
  void operator()(EVP_PKEY* it) const { EVP_PKEY_free(it); }
  void operator()(SSL* it) const { SSL_free(it); }
  void operator()(SSL_CTX* it) const { SSL_CTX_free(it); }
  void operator()(X509* it) const { X509_free(it); }
};
template <class T>
using Owned = std::unique_ptr<T, Freeing>;

/// Why the last call failed, in OpenSSL's words; clears the errors.
[[nodiscard]] std::string last_reason();

/// A read-only view of bytes that must outlive it.
[[nodiscard]] Owned<BIO> bio_of(std::string_view bytes);

/// The certificates of a PEM text, in order; none if one of them is broken.
[[nodiscard]] std::vector<Owned<X509>> certificates_in(std::string_view pem);

/// The unencrypted private key of a PEM text; null if there is none.
[[nodiscard]] Owned<EVP_PKEY> key_in(std::string_view pem);

/// Settings for servers and clients: TLS 1.2 and above, forward secrecy, and no state that outlives
/// a connection.
[[nodiscard]] Owned<SSL_CTX> new_context(const SSL_METHOD* method);

}  // namespace chorus::tls
