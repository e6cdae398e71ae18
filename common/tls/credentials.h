// What each side of a TLS connection needs: a server its certificate, a client the authorities that
// it accepts.  Values: cheap to copy, and equal if their texts are.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.h"

struct ssl_ctx_st;

namespace chorus::tls {

/// A server's certificate, the certificates between it and its authority, and its private key.
class Identity {
 public:
  /// Reads two PEM files.  An Error names the file and what to change: missing, not readable, not
  /// PEM, an encrypted key, or the key of another certificate.
  [[nodiscard]] static Result<Identity> load(const std::string& certificate_file,
                                             const std::string& key_file);
  /// load() from PEM texts; an Error's context is "certificate" or "key".
  [[nodiscard]] static Result<Identity> of(std::string certificate, const std::string& key);

  [[nodiscard]] ssl_ctx_st* context() const { return context_.get(); }
  /// In PEM, without the key.
  [[nodiscard]] const std::string& certificate() const { return *certificate_; }
  bool operator==(const Identity& other) const { return *certificate_ == *other.certificate_; }

 private:
  Identity() = default;
  std::shared_ptr<const std::string> certificate_;
  std::shared_ptr<ssl_ctx_st> context_;
};

/// The authorities that a client accepts.  A client cannot accept every certificate.
class Trust {
 public:
  Trust() = default;  ///< The authorities of the operating system.

  /// Trusts only the authorities in a PEM file; `file` empty: those of the operating system.  The
  /// certificate of a single server works as well.
  [[nodiscard]] static Result<Trust> load(const std::string& file);
  /// load() from a PEM text; `name` is used in messages.
  [[nodiscard]] static Result<Trust> of(std::string authorities, std::string name);

  /// Never null.  All default-constructed values share one context, created on first use.
  [[nodiscard]] std::shared_ptr<ssl_ctx_st> context() const;
  /// For messages: "those in /etc/chorus/tls/ca.crt", "the authorities of this system".
  [[nodiscard]] std::string name() const;
  bool operator==(const Trust& other) const { return text_ == other.text_ && name_ == other.name_; }

 private:
  std::string text_;
  std::string name_;
  std::shared_ptr<ssl_ctx_st> context_;
};

}  // namespace chorus::tls
