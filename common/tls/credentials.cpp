#include "common/tls/credentials.h"

#include <new>
#include <utility>

#include "common/base/file.h"
#include "common/tls/openssl.h"

namespace chorus::tls {
namespace {

constexpr std::uintmax_t kMaxBytes = 1u << 20;  // the system's authorities are 200 kB

/// The error with the file as its context.
tl::unexpected<Error> in_file(const std::string& file, Error wrong) {
  wrong.context = file;
  return tl::unexpected<Error>(std::move(wrong));
}

Result<std::string> readable(const std::string& file) {
  auto text = read_file(file, kMaxBytes);
  if (text) return text;
  return fail(text.error().code, file,
              text.error().message +
                  "; `chorus init certificate` makes certificates, and the "
                  "service's user has to be able to read them");
}

}  // namespace

Result<Identity> Identity::of(std::string certificate, const std::string& key) {
  const auto chain = certificates_in(certificate);
  if (chain.empty()) {
    return fail(ErrorCode::Malformed, "certificate",
                "holds no certificate; PEM is needed (-----BEGIN CERTIFICATE-----)");
  }
  const auto own = key_in(key);
  if (!own) {
    return fail(ErrorCode::Malformed, "key",
                "holds no private key that can be read; an unencrypted one in PEM is needed "
                "(-----BEGIN PRIVATE KEY-----)");
  }
  Owned<SSL_CTX> context = new_context(TLS_server_method());
  if (SSL_CTX_use_certificate(context.get(), chain.front().get()) != 1) {
    return fail(ErrorCode::Malformed, "certificate", "cannot be used: " + last_reason());
  }
  for (std::size_t i = 1; i < chain.size(); ++i)
    SSL_CTX_add1_chain_cert(context.get(), chain[i].get());
  if (SSL_CTX_use_PrivateKey(context.get(), own.get()) != 1 ||
      SSL_CTX_check_private_key(context.get()) != 1) {
    (void)last_reason();
    return fail(ErrorCode::Malformed, "key", "belongs to another certificate");
  }
  Identity identity;
  identity.certificate_ = std::make_shared<const std::string>(std::move(certificate));
  identity.context_ = std::move(context);
  return identity;
}

Result<Identity> Identity::load(const std::string& certificate_file, const std::string& key_file) {
  auto certificate = readable(certificate_file);
  if (!certificate) return pass(certificate);
  const auto key = readable(key_file);
  if (!key) return pass(key);
  auto identity = of(std::move(*certificate), *key);
  if (identity) return identity;
  return in_file(identity.error().context == "key" ? key_file : certificate_file, identity.error());
}

Result<Trust> Trust::of(std::string authorities, std::string name) {
  const auto all = certificates_in(authorities);
  if (all.empty()) {
    return fail(ErrorCode::Malformed, std::move(name),
                "holds no certificate; give the ca.crt of your authority, in PEM");
  }
  Owned<SSL_CTX> context = new_context(TLS_client_method());
  X509_STORE* const store = SSL_CTX_get_cert_store(context.get());
  for (const auto& one : all) X509_STORE_add_cert(store, one.get());
  X509_STORE_set_flags(store, X509_V_FLAG_PARTIAL_CHAIN);
  Trust trust;
  trust.text_ = std::move(authorities);
  trust.name_ = std::move(name);
  trust.context_ = std::move(context);
  return trust;
}

Result<Trust> Trust::load(const std::string& file) {
  if (file.empty()) return Trust();
  auto text = read_file(file, kMaxBytes);
  if (!text) {
    return fail(text.error().code, file,
                text.error().message +
                    "; name the ca.crt of the authority that signed the "
                    "servers' certificates");
  }
  return of(std::move(*text), file);
}

std::shared_ptr<ssl_ctx_st> Trust::context() const {
  if (context_) return context_;
  static const std::shared_ptr<ssl_ctx_st> of_system = [] {
    std::shared_ptr<ssl_ctx_st> made = new_context(TLS_client_method());
    SSL_CTX_set_default_verify_paths(made.get());
    return made;
  }();
  return of_system;
}

std::string Trust::name() const {
  return text_.empty() ? "the authorities of this system" : "those in " + name_;
}

}  // namespace chorus::tls
