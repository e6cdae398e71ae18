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
constexpr std::string_view kTooManyOfOne =
    "its address has as many clients already as outputs.natnet.max_clients_per_address allows";
constexpr std::size_t kMaxKnocks = 4096;

/// A request with a fixed answer; a string that ends in a comma stands for all requests that begin
/// with it.
struct Known {
  std::string_view text;
  std::int32_t number;
};
constexpr std::array kNumbers{
    Known{"AnalogSamplesPerMocapFrame", 0},
    Known{"UpAxis", 1},  // 0: x, 1: y, 2: z.
    // All models are always sent, whatever a client subscribes to.
    Known{"SubscribeToData", 0},
    Known{"SubscribeToData,", 0},
    Known{"SubscribeByID,", 0},
};
constexpr float kMillimetresPerUnit = 1000.0F;

bool matches(const Known& known, std::string_view text) {
  return known.text.ends_with(',') ? text.starts_with(known.text) : text == known.text;
}

std::size_t count_of(const std::map<Address, SteadyTime>& heard, std::uint32_t host) {
  constexpr std::uint16_t kLastPort = 65535;
  return static_cast<std::size_t>(
      std::distance(heard.lower_bound({host, 0}), heard.upper_bound({host, kLastPort})));
}

}  // namespace

CommandDesk::CommandDesk(DeskOptions options)
    : options_(std::move(options)), allowance_(options_.answers) {}

Reply CommandDesk::answer(std::span<const char> datagram, const Address& from, const Now& now) {
  const auto request = read_request(datagram);
  if (!request) return {{}, "malformed"};
  if (is_an_answer(request->message)) return {{}, "an answer to nothing we asked"};
  if (const auto why = admit(*request, from, now.steady); !why.empty()) return {{}, why};
  Reply reply = reply_to(*request, now);
  if (!allowance_.take(static_cast<double>(reply.bytes.size()), now.steady)) {
    return {{}, "too much is asked of us"};
  }
  return reply;
}

std::string_view CommandDesk::objection(const Address& from) const {
  if (heard_.size() >= options_.max_clients) return kTooMany;
  if (count_of(heard_, from.host) >= options_.max_clients_per_address) return kTooManyOfOne;
  return {};
}

void CommandDesk::knock(const Address& from, SteadyTime now) {
  // So many addresses that asked once must be a flood; a real client will ask again.
  if (knocks_.size() >= kMaxKnocks) knocks_.clear();
  if (count_of(knocks_, from.host) >= options_.max_clients_per_address) {
    knocks_.erase(knocks_.lower_bound({from.host, 0}));
  }
  knocks_[from] = now;
}

std::string_view CommandDesk::admit(const Incoming& request, const Address& from, SteadyTime now) {
  expire(now);
  if (request.message == Message::Disconnect) {
    heard_.erase(from);
    knocks_.erase(from);
    return {};
  }
  if (const auto known = heard_.find(from); known != heard_.end()) {
    known->second = now;
    return {};
  }
  const bool asks_for_frames = request.message == Message::KeepAlive ||
                               (request.message == Message::Connect && !options_.info.multicast);
  const auto knocked = knocks_.find(from);
  const bool has_knocked =
      knocked != knocks_.end() && now - knocked->second <= options_.client_timeout;
  if (!asks_for_frames && !has_knocked) return {};
  const std::string_view why = objection(from);
  if (!why.empty()) return asks_for_frames ? why : std::string_view();
  if (has_knocked) {
    knocks_.erase(from);
    heard_.emplace(from, now);
  } else {
    knock(from, now);
  }
  return {};
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

/// The reply to a request; empty if the request is unknown.
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

/// Mean rate of the newest frames [Hz]; zero until there are two.
float CommandDesk::frame_rate() const {
  if (instants_.size() < 2) return 0.0F;
  const double span = seconds(instants_.back() - instants_.front());
  return static_cast<float>(static_cast<double>(instants_.size() - 1) / span);
}

void CommandDesk::expire(SteadyTime now) {
  const auto silent = [&](const auto& each) { return now - each.second > options_.client_timeout; };
  std::erase_if(heard_, silent);
  if (now - tidied_ < options_.client_timeout) return;  // Limits the cost of a flood.
  tidied_ = now;
  std::erase_if(knocks_, silent);
}

std::vector<Address> CommandDesk::clients(SteadyTime now) {
  expire(now);
  std::vector<Address> all;
  for (const auto& [address, when] : heard_) all.push_back(address);
  return all;
}

}  // namespace chorus::natnet
