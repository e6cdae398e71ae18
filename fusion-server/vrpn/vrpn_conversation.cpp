#include "fusion-server/vrpn/vrpn_conversation.h"

#include <utility>

namespace chorus::vrpn {
namespace {

constexpr std::string_view kPing = "vrpn_Base ping_message";
constexpr std::string_view kControl = "VRPN Control";  // Every client's own sender.
constexpr std::int32_t kMinDatagramPort = 1024;
constexpr std::int32_t kMaxDatagramPort = 65535;

Result<void> check_id(std::int32_t id) {
  if (id >= 0 && id < kMaxNames) return {};
  return fail(ErrorCode::Malformed, "VRPN", "a description of number " + std::to_string(id));
}

}  // namespace

Conversation::Conversation(std::shared_ptr<const Trackers> trackers, Peer peer)
    : trackers_(std::move(trackers)), peer_(std::move(peer)), wanted_(trackers_->size()) {}

Result<std::string> Conversation::receive(std::string_view bytes, Timestamp now) {
  std::string answer;
  if (!established_) {
    const std::size_t missing = kCookieBytes - cookie_.size();
    cookie_.append(bytes.substr(0, missing));
    if (cookie_.size() < kCookieBytes) return answer;
    if (auto ok = check_cookie(cookie_); !ok) return pass(ok);
    established_ = true;
    answer = trackers_->descriptions();
    bytes.remove_prefix(missing);
  }
  reader_.add(bytes);
  while (true) {
    const auto message = reader_.next();
    if (!message) return pass(message);
    if (!*message) return answer;
    if (auto ok = obey(**message, now, answer); !ok) return pass(ok);
  }
}

Result<void> Conversation::obey(const Message& message, Timestamp now, std::string& answer) {
  switch (static_cast<SystemType>(message.type)) {
    case SystemType::Sender:
      return take_sender(message);
    case SystemType::Type:
      return take_type(message);
    case SystemType::Datagrams:
      take_datagram_port(message);
      return {};
    case SystemType::Log:  // It would make us write files.
      return {};
  }
  if (ping_type_ == message.type) answer_ping(message, now, answer);
  return {};  // Requests to trackers, none of which ours can fulfil.
}

Result<void> Conversation::take_sender(const Message& message) {
  const auto name = read_description(message.payload);
  if (!name) return pass(name);
  if (auto ok = check_id(message.sender); !ok) return ok;
  const auto id = static_cast<std::size_t>(message.sender);
  if (id >= tracker_of_sender_.size()) tracker_of_sender_.resize(id + 1);
  tracker_of_sender_[id] = trackers_->index_of(*name);
  if (!tracker_of_sender_[id] && *name != kControl) unknown_ = std::string(*name);
  wants_all_ = true;
  wanted_.assign(trackers_->size(), false);
  for (const auto& tracker : tracker_of_sender_) {
    if (!tracker) continue;
    wanted_[*tracker] = true;
    wants_all_ = false;
  }
  return {};
}

Result<void> Conversation::take_type(const Message& message) {
  const auto name = read_description(message.payload);
  if (!name) return pass(name);
  if (auto ok = check_id(message.sender); !ok) return ok;
  if (*name == kPing) {
    ping_type_ = message.sender;
  } else if (ping_type_ == message.sender) {
    ping_type_.reset();
  }
  return {};
}

/// Accepts only the host at the other end of the connection: a client must not direct our data to
/// other hosts.
void Conversation::take_datagram_port(const Message& message) {
  const std::string_view address = message.payload.substr(0, message.payload.find('\0'));
  const std::int32_t port = message.sender;
  const bool usable = port >= kMinDatagramPort && port <= kMaxDatagramPort;
  if (!peer_.asked_by_datagram || address != peer_.address || !usable) return;
  datagram_port_ = static_cast<std::uint16_t>(port);
}

void Conversation::answer_ping(const Message& message, Timestamp now, std::string& answer) {
  const auto id = static_cast<std::size_t>(message.sender);
  if (message.sender < 0 || id >= tracker_of_sender_.size() || !tracker_of_sender_[id]) return;
  append_message(answer,
                 {now, static_cast<std::int32_t>(*tracker_of_sender_[id]),
                  static_cast<std::int32_t>(ReportType::Pong), stream_sequence_++},
                 {});
}

std::string Conversation::stream(const Reports& reports) {
  std::string out;
  for (const Report& message : reports.messages) {
    if (!wants(message.tracker)) continue;
    const std::size_t begin = out.size();
    out.append(reports.bytes, message.begin, message.size);
    set_sequence(out.data() + begin, stream_sequence_++);
  }
  return out;
}

std::vector<std::string> Conversation::datagrams(const Reports& reports) {
  std::vector<std::string> out;
  for (const Report& message : reports.messages) {
    if (!wants(message.tracker)) continue;
    if (out.empty() || out.back().size() + message.size > kMaxDatagram) {
      out.emplace_back().reserve(kMaxDatagram);
    }
    const std::size_t begin = out.back().size();
    out.back().append(reports.bytes, message.begin, message.size);
    set_sequence(out.back().data() + begin, datagram_sequence_++);
  }
  return out;
}

}  // namespace chorus::vrpn
