#include "common/tls/seal.h"

#include <array>
#include <new>
#include <utility>

#include <openssl/err.h>
#include <openssl/x509v3.h>

#include "common/tls/certificate.h"
#include "common/tls/openssl.h"

namespace chorus::tls {
namespace {

/// What an alert from the other side, or bytes that are not TLS, mean for people on this side.
struct Reason {
  int code;
  std::string_view words;
};
constexpr std::array kReasons{
    Reason{SSL_R_HTTP_REQUEST, "sends http without TLS; ask https:// there"},
    Reason{SSL_R_WRONG_VERSION_NUMBER,
           "does not speak TLS on this port; write http:// in its address, or give it a "
           "certificate (http.tls)"},
    Reason{SSL_R_UNSUPPORTED_PROTOCOL, "speaks no TLS newer than 1.1; at least 1.2 is needed"},
    Reason{SSL_R_NO_SHARED_CIPHER, "has no cipher in common with us; at least TLS 1.2 is needed"},
    Reason{SSL_R_TLSV1_ALERT_UNKNOWN_CA,
           "does not know the authority of our certificate; give it the ca.crt"},
    Reason{SSL_R_SSLV3_ALERT_BAD_CERTIFICATE,
           "refuses our certificate; is it for the name it asks for, and is the authority known "
           "there?"},
    Reason{SSL_R_SSLV3_ALERT_CERTIFICATE_EXPIRED,
           "says that our certificate has expired; renew it (chorus init certificate), reload"},
    Reason{SSL_R_SSLV3_ALERT_CERTIFICATE_UNKNOWN,
           "refuses our certificate; is the authority known there?"},
};

std::string words_for(unsigned long code) {
  for (const Reason& reason : kReasons) {
    if (ERR_GET_LIB(code) == ERR_LIB_SSL && ERR_GET_REASON(code) == reason.code)
      return std::string(reason.words);
  }
  const char* const text = ERR_reason_error_string(code);
  return std::string("speaks no TLS that we understand: ") +
         (text == nullptr ? "it broke off" : text);
}

/// Keeps the facts of a certificate that is refused, because OpenSSL does not keep the certificate.
int note_objection(int accepted, X509_STORE_CTX* checking) {
  const void* const ssl =
      X509_STORE_CTX_get_ex_data(checking, SSL_get_ex_data_X509_STORE_CTX_idx());
  const X509* const shown = X509_STORE_CTX_get_current_cert(checking);
  auto* const facts =
      static_cast<CertificateFacts*>(SSL_get_app_data(static_cast<const SSL*>(ssl)));
  if (accepted != 1 && shown != nullptr) *facts = facts_of(*shown);
  return accepted;
}

std::string list_of(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text.append(text.empty() ? "" : ", ").append(name);
  return text.empty() ? "nobody" : text;
}

}  // namespace

void Seal::Freeing::operator()(ssl_st* it) const { SSL_free(it); }
Seal::~Seal() = default;

Seal Seal::over(ssl_ctx_st* context) {
  Seal seal;
  seal.ssl_.reset(SSL_new(context));
  BIO* const in = BIO_new(BIO_s_mem());
  BIO* const out = BIO_new(BIO_s_mem());
  if (!seal.ssl_ || in == nullptr || out == nullptr) throw std::bad_alloc();
  BIO_set_mem_eof_return(in, -1);  // empty means nothing yet, not the end
  SSL_set_bio(seal.ssl_.get(), in, out);
  return seal;
}

Seal Seal::of_server(const Identity& identity) {
  Seal seal = over(identity.context());
  SSL_set_accept_state(seal.ssl_.get());
  return seal;
}

Seal Seal::of_client(const Trust& trust, std::string host) {
  Seal seal = over(trust.context().get());
  SSL* const ssl = seal.ssl_.get();
  SSL_set_connect_state(ssl);
  seal.refused_ = std::make_unique<CertificateFacts>();
  SSL_set_app_data(ssl, seal.refused_.get());
  SSL_set_verify(ssl, SSL_VERIFY_PEER, note_objection);
  X509_VERIFY_PARAM* const wanted = SSL_get0_param(ssl);
  X509_VERIFY_PARAM_set_hostflags(wanted, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  if (X509_VERIFY_PARAM_set1_ip_asc(wanted, host.c_str()) != 1) {
    X509_VERIFY_PARAM_set1_host(wanted, host.data(), host.size());
    SSL_set_tlsext_host_name(ssl, host.c_str());
  }
  ERR_clear_error();
  seal.trust_ = trust;
  seal.host_ = std::move(host);
  return seal;
}

void Seal::receive(std::string_view bytes) {
  BIO* const in = SSL_get_rbio(ssl_.get());
  if (BIO_write(in, bytes.data(), static_cast<int>(bytes.size())) != static_cast<int>(bytes.size()))
    throw std::bad_alloc();
}

std::string Seal::take_output() {
  BIO* const out = SSL_get_wbio(ssl_.get());
  std::string bytes(BIO_ctrl_pending(out), '\0');
  if (!bytes.empty()) BIO_read(out, bytes.data(), static_cast<int>(bytes.size()));
  return bytes;
}

Seal::Step Seal::handshake() {
  ERR_clear_error();
  const Step step = step_of(SSL_do_handshake(ssl_.get()));
  if (step != Step::Ended) return step;
  failure_ = {ErrorCode::Unavailable, host_, "ended the TLS handshake without a reason"};
  return Step::Failed;
}

Seal::Heard Seal::read(std::span<char> room) {
  ERR_clear_error();
  std::size_t size = 0;
  const int result = SSL_read_ex(ssl_.get(), room.data(), room.size(), &size);
  return {step_of(result), size};
}

Seal::Step Seal::write(std::string_view said) {
  ERR_clear_error();
  std::size_t size = 0;
  return step_of(SSL_write_ex(ssl_.get(), said.data(), said.size(), &size));
}

void Seal::say_end() {
  if (SSL_is_init_finished(ssl_.get()) == 1) SSL_shutdown(ssl_.get());
  ERR_clear_error();
}

Seal::Step Seal::step_of(int result) {
  if (result > 0) return Step::Done;
  switch (SSL_get_error(ssl_.get(), result)) {
    case SSL_ERROR_WANT_READ:
    case SSL_ERROR_WANT_WRITE:
      return Step::NeedsInput;
    case SSL_ERROR_ZERO_RETURN:
      return Step::Ended;
    default:
      break;
  }
  const std::string objection = this->objection();
  failure_ = {objection.empty() ? ErrorCode::Unavailable : ErrorCode::Forbidden, host_,
              objection.empty() ? words_for(ERR_peek_last_error()) : objection};
  ERR_clear_error();
  return Step::Failed;
}

/// Why the client refuses the certificate that it was shown; empty if it does not.
std::string Seal::objection() const {
  const long verdict = SSL_get_verify_result(ssl_.get());
  if (!trust_ || verdict == X509_V_OK) return {};
  const CertificateFacts& facts = *refused_;
  switch (verdict) {
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return "its certificate, or that of its authority, has expired (it was good until " +
             date_text(facts.not_after) +
             "); renew it with `chorus init certificate` and reload that service. Is the clock of "
             "this host right?";
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "its certificate is not good before " + date_text(facts.not_before) +
             "; set the clock of this host, or of the one that made it";
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return "its certificate is for " + list_of(facts.names) + ", not for " + host_ +
             "; ask it by one of these, or make one with `chorus init certificate " + host_ + "`";
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
      return "its certificate is signed by " + (facts.issuer.empty() ? "somebody" : facts.issuer) +
             ", who is not among " + trust_->name() +
             "; name the ca.crt of that authority (chorus: --ca or CHORUS_CA; chorus-fusion: "
             "poll.ca)";
    default:
      return std::string("its certificate is refused: ") + X509_verify_cert_error_string(verdict);
  }
}

}  // namespace chorus::tls
