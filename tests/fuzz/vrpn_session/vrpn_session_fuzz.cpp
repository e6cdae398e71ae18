// A VRPN conversation: however its input is split, its output is the same and can be read.
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "fusion-server/vrpn/vrpn_conversation.h"

namespace {

using namespace chorus::vrpn;

void require(bool holds) {
  if (!holds) std::abort();
}

std::shared_ptr<const Trackers> trackers() {
  static const auto kTrackers = std::make_shared<const Trackers>(2, true);
  return kTrackers;
}

struct Spoken {
  std::string answers;
  bool ended = false;
};

Spoken speak(Conversation& conversation, std::string_view bytes, std::size_t piece) {
  Spoken out;
  while (!bytes.empty() && !out.ended) {
    const auto answer = conversation.receive(bytes.substr(0, piece), chorus::from_unix_ns(1));
    out.ended = !answer;
    if (answer) out.answers += *answer;
    bytes.remove_prefix(std::min(piece, bytes.size()));
  }
  return out;
}

void check_messages(std::string_view bytes) {
  MessageReader reader;
  reader.add(bytes);
  std::size_t read = 0;
  while (true) {
    const auto message = reader.next();
    require(message.has_value());
    if (!*message) break;
    read += (kHeaderBytes + (*message)->payload.size() + 7) / 8 * 8;
  }
  require(read == bytes.size());
}

Reports one_pose() {
  chorus::outlet::TrackerFrame frame;
  frame.slots = 2;
  frame.bodies.resize(1);
  for (auto& joint : frame.bodies[0].joints) joint.tracked = true;
  return encode(frame, *trackers());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(bytes), size);
  (void)read_request(text);
  static const Reports kReports = one_pose();
  Conversation whole(trackers(), {"127.0.0.1", true});
  Conversation pieces(trackers(), {"127.0.0.1", true});
  const Spoken at_once = speak(whole, text, text.size());
  const Spoken bit_by_bit = speak(pieces, text, 7);
  require(at_once.ended == bit_by_bit.ended);
  if (at_once.ended) return 0;
  require(at_once.answers == bit_by_bit.answers);
  require(whole.datagram_port() == pieces.datagram_port());
  check_messages(at_once.answers);
  check_messages(whole.stream(kReports));
  for (const std::string& datagram : whole.datagrams(kReports)) {
    require(datagram.size() <= kMaxDatagram);
    check_messages(datagram);
  }
  return 0;
}
