#include "fusion-server/natnet/command_desk.h"

#include <algorithm>
#include <array>
#include <utility>

namespace chorus::natnet {
namespace {

constexpr std::size_t kRateFrames = 31;
constexpr std::string_view kUnknown = "nobody knows this request";
constexpr std::string_view kTooMany =
    "there are as many clients already as outputs.natnet.max_clients allows";

/// Requests with one answer; a text that ends in a comma stands for all that begin with it.
struct Known {
  std::string_view text;
  std::int32_t number;
};
constexpr std::array kNumbers{
    Known{"AnalogSamplesPerMocapFrame", 0},
    Known{"UpAxis", 1},  // 0 x, 1 y, 2 z
    // All models are sent always: that contains what is subscribed to.
    Known{"SubscribeToData", 0},
    Known{"SubscribeToData,", 0},
    Known{"SubscribeByID,", 0},
};
constexpr float kMillimetresPerUnit = 1000.0F;

bool matches(const Known& known, std::string_view text) {
  return known.text.ends_with(',') ? text.starts_with(known.text) : text == known.text;
}

}  // namespace

CommandDesk::CommandDesk(DeskOptions options)
    : options_(std::move(options)), allowance_(options_.answers) {}

Reply CommandDesk::answer(std::span<const char> datagram, const Address& from, const Now& now) {
  const auto request = read_request(datagram);
  if (!request) return {{}, "malformed"};
  if (is_an_answer(request->message)) return {{}, "an answer to nothing we asked"};
  if (!admit(*request, from, now.steady)) return {{}, kTooMany};
  Reply reply = reply_to(*request, now);
  if (!allowance_.take(static_cast<double>(reply.bytes.size()), now.steady)) {
    return {{}, "too much is asked of us"};
  }
  return reply;
}

/// True also for those who do not want frames.
bool CommandDesk::admit(const Incoming& request, const Address& from, outlet::SteadyTime now) {
  expire(now);
  if (request.message == Message::Disconnect) heard_.erase(from);
  const bool asks_for_frames = request.message == Message::KeepAlive ||
                               (request.message == Message::Connect && !options_.info.multicast);
  const auto known = heard_.find(from);
  if (known != heard_.end()) {
    known->second = now;
  } else if (asks_for_frames) {
    if (heard_.size() >= options_.max_clients) return false;
    heard_.emplace(from, now);
  }
  return true;
}

Reply CommandDesk::reply_to(const Incoming& request, const Now& now) const {
  switch (request.message) {
    case Message::Connect:
    case Message::Discovery:
      return {server_info(options_.info), {}};
    case Message::RequestModels:
      return {options_.models, {}};
    case Message::RequestFrame:
      return {frame_ ? *frame_ : Bytes{}, {}};
    case Message::EchoRequest:
      return {echo(request.stamp, static_cast<std::uint64_t>(to_unix_ns(now.utc))), {}};
    case Message::KeepAlive:
    case Message::Disconnect:
      return {};
    case Message::Request:
      if (Bytes known = reply_to_text(request.text); !known.empty()) return {std::move(known), {}};
      break;
    default:
      break;
  }
  return {unrecognized(), kUnknown};
}

/// Empty: not known.
Bytes CommandDesk::reply_to_text(std::string_view text) const {
  if (text == "FrameRate") return response(frame_rate());
  if (text == "UnitsToMillimeters") return response(kMillimetresPerUnit);
  const auto* known = std::find_if(kNumbers.begin(), kNumbers.end(),
                                   [text](const Known& each) { return matches(each, text); });
  return known == kNumbers.end() ? Bytes{} : response(known->number);
}

void CommandDesk::newest(std::shared_ptr<const Bytes> frame, Timestamp instant) {
  frame_ = std::move(frame);
  if (!instants_.empty() && instant <= instants_.back()) instants_.clear();
  instants_.push_back(instant);
  if (instants_.size() > kRateFrames) instants_.pop_front();
}

/// Zero before two frames.
float CommandDesk::frame_rate() const {
  if (instants_.size() < 2) return 0.0F;
  const double span = seconds(instants_.back() - instants_.front());
  return static_cast<float>(static_cast<double>(instants_.size() - 1) / span);
}

void CommandDesk::expire(outlet::SteadyTime now) {
  std::erase_if(heard_,
                [&](const auto& each) { return now - each.second > options_.client_timeout; });
}

std::vector<Address> CommandDesk::clients(outlet::SteadyTime now) {
  expire(now);
  std::vector<Address> all;
  for (const auto& [address, when] : heard_) all.push_back(address);
  return all;
}

}  // namespace chorus::natnet
