// TLS for chorus_push.h, which includes this where CHORUS_PUSH_TLS is defined.  OpenSSL 1.1 or later.
#pragma once

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <string>

namespace chorus {

/// TLS 1.2 or 1.3 over a stream.  The server's certificate has to be for the host's name or address, and of an authority that is
/// believed; nothing turns that off.
class Tls {
 public:
  Tls() = default;
  Tls(const Tls&) = delete;
  Tls& operator=(const Tls&) = delete;
  ~Tls() { close(); }
  bool is_open() const { return ssl_ != nullptr; }
  void close() {
    ::SSL_free(ssl_);
    ::SSL_CTX_free(context_);
    ssl_ = nullptr;
    context_ = nullptr;
  }

  /// Returns what went wrong; empty: nothing.
  std::string open(Stream& stream, const std::string& host, const std::string& ca, int patience_ms) {
    close();
    context_ = ::SSL_CTX_new(::TLS_client_method());
    ::SSL_CTX_set_min_proto_version(context_, TLS1_2_VERSION);
    ::SSL_CTX_set_verify(context_, SSL_VERIFY_PEER, nullptr);
    const bool believed = ca.empty() ? ::SSL_CTX_set_default_verify_paths(context_) == 1
                                     : ::SSL_CTX_load_verify_locations(context_, ca.c_str(), nullptr) == 1;
    if (host.empty()) return "there is no host name to check the certificate against";
    if (!believed) return "no certificate can be read from " + ca;
    ssl_ = ::SSL_new(context_);
    X509_VERIFY_PARAM* const wanted = ::SSL_get0_param(ssl_);
    if (::X509_VERIFY_PARAM_set1_ip_asc(wanted, host.c_str()) != 1) {  // it is a name
      if (::X509_VERIFY_PARAM_set1_host(wanted, host.c_str(), 0) != 1) return "this is no host name: " + host;
      ::SSL_set_tlsext_host_name(ssl_, host.c_str());
    }
    ::SSL_set_connect_state(ssl_);
    ::SSL_set_bio(ssl_, ::BIO_new(::BIO_s_mem()), ::BIO_new(::BIO_s_mem()));  // it owns both
    return shake_hands(stream, patience_ms);
  }
  bool send(Stream& stream, const std::string& bytes) {
    ::ERR_clear_error();
    return ::SSL_write(ssl_, bytes.data(), static_cast<int>(bytes.size())) > 0 && flush(stream);
  }
  /// As Stream::receive.
  bool receive(Stream& stream, std::string& bytes, int patience_ms) {
    const std::size_t before = bytes.size();
    while (true) {
      std::string sealed;
      const bool open = stream.receive(sealed, patience_ms);
      ::BIO_write(::SSL_get_rbio(ssl_), sealed.data(), static_cast<int>(sealed.size()));
      char chunk[4096];
      int n = 0;
      ::ERR_clear_error();
      while ((n = ::SSL_read(ssl_, chunk, sizeof chunk)) > 0) bytes.append(chunk, static_cast<std::size_t>(n));
      const bool goes_on = ::SSL_get_error(ssl_, n) == SSL_ERROR_WANT_READ && flush(stream) && open;
      if (bytes.size() > before) return true;  // the last words are heard before the end is told
      // A session ticket, or a part of a record, is no answer yet.
      if (!goes_on || sealed.empty()) return goes_on;
    }
  }

 private:
  std::string shake_hands(Stream& stream, int patience_ms) {
    while (true) {
      ::ERR_clear_error();
      const int done = ::SSL_do_handshake(ssl_);
      const int why = ::SSL_get_error(ssl_, done);
      if (!flush(stream)) return "it closed the connection during the TLS handshake";
      if (done == 1) return {};
      if (why != SSL_ERROR_WANT_READ) return reason();
      std::string sealed;
      if (!stream.receive(sealed, patience_ms) || sealed.empty()) return "it does not answer the TLS handshake";
      ::BIO_write(::SSL_get_rbio(ssl_), sealed.data(), static_cast<int>(sealed.size()));
    }
  }
  std::string reason() const {
    const long verdict = ::SSL_get_verify_result(ssl_);
    if (verdict != X509_V_OK) return std::string("its certificate: ") + ::X509_verify_cert_error_string(verdict);
    const char* const text = ::ERR_reason_error_string(::ERR_peek_error());
    return std::string("TLS: ") + (text == nullptr ? "failed" : text);
  }
  bool flush(Stream& stream) {
    std::string sealed(::BIO_ctrl_pending(::SSL_get_wbio(ssl_)), '\0');
    if (sealed.empty()) return true;
    ::BIO_read(::SSL_get_wbio(ssl_), sealed.data(), static_cast<int>(sealed.size()));
    return stream.send(sealed);
  }
  SSL_CTX* context_ = nullptr;
  SSL* ssl_ = nullptr;
};

}  // namespace chorus
