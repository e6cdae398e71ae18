#include "fusion-server/nats/frame_desk.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/base/json.h"
#include "common/base/shortened.h"
#include "common/resource/frame_resource.h"
#include "fusion-server/nats/json_fields.h"
#include "fusion-server/wire/snapshot_resource.h"

namespace chorus::nats {
namespace {

constexpr std::size_t kMostAsked = 256;
/// A frame of another cell: 64 people with all that fusion knows of them have not half of it.
constexpr JsonLimits kFrameLimits{.bytes = 4U << 20U, .nesting = 16};

std::string frame_text(const Snapshot& snapshot) {
  return resource::write(wire::to_resource(snapshot), resource::Format::Json);
}

std::string written(const nlohmann::json& object) {
  return object.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string refusal(const std::string& why) { return written({{"error", why}}); }

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
    kept_.push_back({snapshot, nullptr});
    while (!kept_.empty() &&
           (kept_.front().snapshot->instant < now - kKept || kept_.size() > kMostKept))
      kept_.pop_front();
    const auto since = std::chrono::steady_clock::now() - wanted_;
    if (!ever_wanted_ || since > kWanted) return;
    broker = broker_;
    subject = subject_;
  }
  if (broker != nullptr) broker->publish(subject, *text_of({snapshot, nullptr}));
}

std::shared_ptr<const std::string> FrameDesk::text_of(const Kept& kept) {
  if (kept.text) return kept.text;
  const auto text = std::make_shared<const std::string>(frame_text(*kept.snapshot));
  const std::scoped_lock lock(mutex_);
  const auto found = std::ranges::find(kept_, kept.snapshot, &Kept::snapshot);
  if (found != kept_.end()) found->text = text;
  return text;
}

void FrameDesk::want() {
  const std::scoped_lock lock(mutex_);
  wanted_ = std::chrono::steady_clock::now();
  ever_wanted_ = true;
}

std::string FrameDesk::frame_at(std::string_view request) {
  std::optional<Timestamp> at;
  if (!request.empty()) {
    const auto parsed = parse_json(request, {kMostAsked, 2});
    if (!parsed) return refusal(to_string(parsed.error()));
    JsonFields fields(*parsed, "");
    at = fields.maybe_time("at");
    if (fields.error()) return refusal(to_string(*fields.error()));
  }
  Kept found;
  {
    const std::scoped_lock lock(mutex_);
    for (const Kept& each : kept_)
      if (!at || each.snapshot->instant <= *at) found = each;
  }
  return found.snapshot ? *text_of(found)
                        : refusal("there is no frame of that time any more, or yet");
}

void FrameDesk::answer(const Message& message) {
  if (message.reply.empty()) return;
  const std::string text = frame_at(message.bytes);
  Broker* broker = nullptr;
  {
    const std::scoped_lock lock(mutex_);
    broker = broker_;
  }
  if (broker != nullptr) broker->publish(std::string(message.reply), text);
}

std::string frame_question(const std::string& at) {
  return at.empty() ? std::string() : written({{"at", at}});
}

Result<std::string> frame_answered(const std::string& cell, std::string answer) {
  const std::string who = "cell " + cell;
  const auto nonsense = [&who](std::string_view why) {
    return fail(ErrorCode::Unavailable, who, "answers no frame: " + shortened(why, kMaxReason));
  };
  const auto read = parse_json(answer, kFrameLimits);
  if (!read) return nonsense(to_string(read.error()));
  if (!read->is_object()) return nonsense("it is no object");
  const auto why = read->find("error");
  if (why == read->end() && read->contains("sequence")) return answer;
  if (why == read->end() || !why->is_string()) return nonsense("it has no sequence");
  return fail(ErrorCode::NotFound, who, shortened(why->get_ref<const std::string&>(), kMaxReason));
}

}  // namespace chorus::nats
