// NatNet's command channel: any datagrams from any host lead to answers of limited size and few
// clients.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "fusion-server/natnet/command_desk.h"

namespace {

using namespace chorus;
using namespace chorus::natnet;

constexpr std::size_t kModels = 2000;
constexpr std::size_t kServerInfo = 4 + 279;

void require(bool holds) {
  if (!holds) std::abort();
}

CommandDesk desk(bool multicast) {
  DeskOptions options;
  options.info.multicast = multicast;
  options.models = message_of(Message::Models, Bytes(kModels));
  options.max_clients = 3;
  CommandDesk made(std::move(options));
  made.newest(std::make_shared<const Bytes>(message_of(Message::Frame, Bytes(100))), Timestamp{});
  return made;
}

void check(const Reply& reply, std::span<const char> datagram) {
  require(reply.bytes.size() <= std::max(kModels + 4, kServerInfo));
  if (reply.bytes.empty()) return;
  require(datagram.size() >= 4);
  require(number_at<std::uint16_t>(reply.bytes, 2) == reply.bytes.size() - 4);
  // Messages that are answers themselves must not be answered.
  const auto said = static_cast<Message>(number_at<std::uint16_t>(reply.bytes, 0));
  require(is_an_answer(said));
  require(!is_an_answer(static_cast<Message>(number_at<std::uint16_t>(datagram, 0))));
}

}  // namespace

/// The input holds datagrams, each preceded by a byte for its sender and a byte for its length.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size < 1) return 0;
  CommandDesk made = desk((bytes[0] & 1) != 0);
  Now now{SteadyTime{} + std::chrono::hours(1), Timestamp{}};
  std::span<const char> left(reinterpret_cast<const char*>(bytes + 1), size - 1);
  while (left.size() >= 2) {
    const auto from = static_cast<std::uint8_t>(left[0]);
    const std::size_t length =
        std::min<std::size_t>(static_cast<std::uint8_t>(left[1]), left.size() - 2);
    const auto datagram = left.subspan(2, length);
    left = left.subspan(2 + length);
    now.steady += std::chrono::milliseconds(from);
    check(made.answer(datagram, {from & 7U, 1000}, now), datagram);
    require(made.clients(now.steady).size() <= 3);
  }
  return 0;
}
