// Feeds any bytes to either side of TLS, during a handshake or after one, in pieces; and any text
// as a certificate.  A side reports Done only for data that was sent, and says why it fails.
//
// The first byte chooses: bit 0 the side, bit 1 whether the handshake is complete, bit 2 whether
// the rest is read as a certificate instead.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/tls/authority.h"
#include "common/tls/certificate.h"
#include "common/tls/seal.h"

namespace {

using namespace chorus::tls;
using Step = Seal::Step;

void require(bool holds) {
  if (!holds) std::abort();
}

struct Workshop {
  Issued authority = new_authority("fuzz", for_days(30)).value();
  Issued host = new_certificate(authority, {"localhost"}, for_days(30)).value();
  Identity identity = Identity::of(host.certificate, host.key).value();
  Trust trust = Trust::of(authority.certificate, "ca.crt").value();
};

const Workshop& workshop() {
  static const Workshop made;
  return made;
}

void shake(Seal& client, Seal& server) {
  for (int i = 0; i < 4; ++i) {
    (void)client.handshake();
    server.receive(client.take_output());
    (void)server.handshake();
    client.receive(server.take_output());
  }
}

void check(Seal& side, std::string_view bytes, bool shaken) {
  constexpr std::size_t kPiece = 64;
  std::array<char, 128> room;
  while (true) {
    const Step step = shaken ? side.read(room).step : side.handshake();
    require(step != Step::Done);  // nobody encrypted anything, so nothing was sent
    require((step == Step::Failed) == !side.failure().message.empty());
    (void)side.take_output();
    if (step != Step::NeedsInput || bytes.empty()) break;
    side.receive(bytes.substr(0, kPiece));
    bytes.remove_prefix(std::min(kPiece, bytes.size()));
  }
  side.say_end();
  (void)side.write("anything");
  (void)side.take_output();
}

void check_text(std::string_view text) {
  const auto facts = facts_of(text);
  if (!facts) return;
  for (const std::string& name : facts->names) {
    for (const char c : name) require(c >= ' ' && c <= '~');
  }
  (void)date_text(facts->not_after);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(bytes) + 1, size - 1);
  if ((bytes[0] & 4U) != 0) {
    check_text(rest);
    return 0;
  }
  Seal client = Seal::of_client(workshop().trust, "localhost");
  Seal server = Seal::of_server(workshop().identity);
  const bool shaken = (bytes[0] & 2U) != 0;
  if (shaken) shake(client, server);
  check((bytes[0] & 1U) != 0 ? client : server, rest, shaken);
  return 0;
}
