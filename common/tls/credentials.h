// What a side of a TLS connection has: a server its certificate, a client the authorities it
// believes.  Values: copies are cheap, and equal when their texts are.
#pragma once

#include <memory>
#include <string>

#include "common/base/result.h"

struct ssl_ctx_st;

namespace chorus::tls {

/// The certificate of a server, with those between it and its authority, and its private key.
class Identity {
 public:
  /// Reads two PEM files.  An Error names the file and what to change: missing, not readable, not
  /// PEM, an encrypted key, a key of another certificate.
  [[nodiscard]] static Result<Identity> load(const std::string& certificate_file,
                                             const std::string& key_file);
  /// The same from PEM texts; an Error's context is "certificate" or "key".
  [[nodiscard]] static Result<Identity> of(std::string certificate, const std::string& key);

  [[nodiscard]] ssl_ctx_st* context() const { return context_.get(); }
  /// PEM, without the key.
  [[nodiscard]] const std::string& certificate() const { return *certificate_; }
  bool operator==(const Identity& other) const { return *certificate_ == *other.certificate_; }

 private:
  Identity() = default;
  std::shared_ptr<const std::string> certificate_;
  std::shared_ptr<ssl_ctx_st> context_;
};

/// Whom a client believes.  There is no way to believe everybody.
class Trust {
 public:
  Trust() = default;  ///< The authorities of the operating system.

  /// Those in a PEM file and no others; empty: the operating system's.  The certificate of a single
  /// server will do as well.
  [[nodiscard]] static Result<Trust> load(const std::string& file);
  /// The same from a PEM text; `name` is used in messages.
  [[nodiscard]] static Result<Trust> of(std::string authorities, std::string name);

  /// Never null; made at the first call of a value that was default-constructed.
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
