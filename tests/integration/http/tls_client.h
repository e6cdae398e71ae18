// A client that obeys no protocol, over TLS.
#pragma once

#include <array>
#include <chrono>
#include <string>
#include <string_view>
#include <utility>

#include "common/tls/seal.h"
#include "tests/integration/http/raw_client.h"

namespace chorus::http::test {

class TlsRawClient {
 public:
  TlsRawClient(std::uint16_t port, const tls::Trust& trust)
      : raw_(port), seal_(tls::Seal::of_client(trust, "127.0.0.1")) {
    while (step_ == tls::Seal::Step::NeedsInput) {
      step_ = seal_.handshake();
      raw_.say(seal_.take_output());
      if (step_ == tls::Seal::Step::NeedsInput && !hear_some()) break;
    }
  }

  [[nodiscard]] bool sealed() const { return step_ == tls::Seal::Step::Done; }
  [[nodiscard]] RawClient& raw() { return raw_; }

  bool say(std::string_view text) {
    return seal_.write(text) == tls::Seal::Step::Done && raw_.say(seal_.take_output());
  }

  /// Reads until `text` arrives or the stream ends; returns what was read.
  std::string hear_until(std::string_view text) {
    std::string all;
    std::array<char, 4096> room;
    while (all.find(text) == std::string::npos) {
      const auto heard = seal_.read(room);
      if (heard.step == tls::Seal::Step::Done) {
        all.append(room.data(), heard.size);
      } else if (heard.step != tls::Seal::Step::NeedsInput || !hear_some()) {
        last_ = heard.step;
        break;
      }
    }
    return all;
  }
  /// Reads until the server ends the connection; said_end() tells whether it was a proper end.
  std::string hear_all() { return hear_until("\xff nothing says this \xff"); }
  /// True if the last hear_all() ended with a proper TLS close, not with a broken connection.
  [[nodiscard]] bool said_end() const { return last_ == tls::Seal::Step::Ended; }

 private:
  bool hear_some() {
    const std::string bytes = raw_.hear_some(std::chrono::seconds(5));
    seal_.receive(bytes);
    return !bytes.empty();
  }

  RawClient raw_;
  tls::Seal seal_;
  tls::Seal::Step step_ = tls::Seal::Step::NeedsInput;
  tls::Seal::Step last_ = tls::Seal::Step::Done;
};

}  // namespace chorus::http::test
