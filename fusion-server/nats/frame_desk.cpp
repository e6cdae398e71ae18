#include "fusion-server/nats/frame_desk.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/nats/json_fields.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::nats {
namespace {

constexpr std::size_t kMostAsked = 256;

std::string frame_text(const Snapshot& snapshot) {
  return resource::write(wire::to_resource(snapshot), resource::Format::Json);
}

std::string refusal(const std::string& why) {
  return nlohmann::json{{"error", why}}.dump(-1, ' ', false,
                                             nlohmann::json::error_handler_t::replace);
}

}  // namespace

void FrameDesk::open(Broker& broker, std::string subject) {
  const std::scoped_lock lock(mutex_);
  broker_ = &broker;
  subject_ = std::move(subject);
}

void FrameDesk::show(const std::shared_ptr<const Snapshot>& snapshot, Timestamp now) {
  Broker* broker = nullptr;
  std::string subject;
  {
    const std::scoped_lock lock(mutex_);
    kept_.push_back(snapshot);
    while (!kept_.empty() && kept_.front()->instant < now - kKept) kept_.pop_front();
    const auto since = std::chrono::steady_clock::now() - wanted_;
    if (!ever_wanted_ || since > kWanted) return;
    broker = broker_;
    subject = subject_;
  }
  if (broker != nullptr) broker->publish(subject, frame_text(*snapshot));
}

void FrameDesk::want() {
  const std::scoped_lock lock(mutex_);
  wanted_ = std::chrono::steady_clock::now();
  ever_wanted_ = true;
}

std::string FrameDesk::frame_at(std::string_view request) const {
  std::optional<Timestamp> at;
  if (!request.empty()) {
    const auto parsed = parse_json(request, {kMostAsked, 2});
    if (!parsed) return refusal(to_string(parsed.error()));
    JsonFields fields(*parsed, "");
    at = fields.maybe_time("at");
    if (fields.error()) return refusal(to_string(*fields.error()));
  }
  std::shared_ptr<const Snapshot> found;
  {
    const std::scoped_lock lock(mutex_);
    for (const auto& each : kept_)
      if (!at || each->instant <= *at) found = each;
  }
  return found ? frame_text(*found) : refusal("there is no frame of that time any more, or yet");
}

void FrameDesk::answer(const Message& message) {
  if (message.reply.empty()) return;
  const std::string text = frame_at(message.bytes);
  const std::scoped_lock lock(mutex_);
  if (broker_ != nullptr) broker_->publish(std::string(message.reply), text);
}

}  // namespace chorus::nats
