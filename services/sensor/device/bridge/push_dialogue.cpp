#include "services/sensor/device/bridge/push_dialogue.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/body/bones.h"

namespace chorus::bridge {
namespace {

using Json = nlohmann::json;

constexpr auto kHelloWithin = std::chrono::seconds(5);
// Longest time without a message from the pusher; its answers to our questions for the time count,
// too.
constexpr auto kSilentFor = std::chrono::seconds(30);
constexpr auto kClockEvery = std::chrono::seconds(1);
constexpr auto kErrorEvery = std::chrono::seconds(1);
constexpr int kMaxErrorsInARow = 300;

std::string text_of(const Json& message) {
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<std::string_view> joints_given(const layout::Layout& layout) {
  std::vector<std::string_view> names;
  for (const layout::Recipe& recipe : layout.recipes) {
    const std::string_view name = name_of(recipe.joint);
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

class PushDialogue final : public http::Dialogue {
 public:
  PushDialogue(std::shared_ptr<PushDesk> desk, PushDesk::Guest guest, std::string via,
               std::string address)
      : desk_(std::move(desk)),
        guest_(guest),
        session_(desk_, std::move(via), std::move(address)),
        begun_(desk_->steady_now()),
        heard_(begun_) {}
  ~PushDialogue() override { desk_->disconnect(guest_); }
  PushDialogue(const PushDialogue&) = delete;
  PushDialogue& operator=(const PushDialogue&) = delete;

  [[nodiscard]] http::Reply hear(std::string_view message) override;
  [[nodiscard]] http::Reply look() override;
  [[nodiscard]] http::Reply end(const Error& why) override;

 private:
  [[nodiscard]] std::string welcome() const;
  [[nodiscard]] std::string clock_question();
  [[nodiscard]] http::Reply complain(const Error& error);
  [[nodiscard]] http::Reply send_away(const Error& error);
  [[nodiscard]] http::Reply doubt(const Error& error) const;

  std::shared_ptr<PushDesk> desk_;
  PushDesk::Guest guest_;
  PushSession session_;
  SteadyTime begun_;
  SteadyTime heard_;
  std::optional<SteadyTime> asked_;  ///< When we last asked the pusher for its time.
  /// When the last complaint was sent.  There is at most one per second; errors in between are only
  /// counted.
  std::optional<SteadyTime> complained_;
  std::uint64_t unsaid_ = 0;
  int errors_in_a_row_ = 0;
};

std::string PushDialogue::welcome() const {
  return text_of({{"type", "welcome"},
                  {"version", 1},
                  {"sensor", desk_->options().sensor.str()},
                  {"maxRateHz", desk_->options().settings.max_rate_hz},
                  {"joints", joints_given(*session_.hello()->layout)}});
}

std::string PushDialogue::clock_question() {
  asked_ = desk_->steady_now();
  return text_of({{"type", "clock"}, {"sent", std::to_string(to_unix_ns(desk_->now()))}});
}

http::Reply PushDialogue::send_away(const Error& error) {
  session_.leave_because(to_string(error));
  return {{text_of({{"type", "bye"},
                    {"code", name_of(error.code)},
                    {"context", error.context},
                    {"detail", error.message}})},
          true};
}

http::Reply PushDialogue::doubt(const Error& error) const {
  return {{text_of({{"type", "doubt"}, {"context", error.context}, {"detail", error.message}})}};
}

http::Reply PushDialogue::complain(const Error& error) {
  const SteadyTime now = desk_->steady_now();
  if (++errors_in_a_row_ > kMaxErrorsInARow) {
    return send_away({ErrorCode::Malformed, error.context,
                      "too many messages in a row were refused; the last: " + error.message});
  }
  if (complained_ && now - *complained_ < kErrorEvery) {
    ++unsaid_;
    return {};
  }
  complained_ = now;
  return {{text_of({{"type", "error"},
                    {"code", name_of(error.code)},
                    {"context", error.context},
                    {"detail", error.message},
                    {"unsaid", std::exchange(unsaid_, 0)}})}};
}

http::Reply PushDialogue::hear(std::string_view message) {
  heard_ = desk_->steady_now();
  const auto heard = session_.hear(message);
  if (!heard) return session_.lost() ? send_away(heard.error()) : complain(heard.error());
  if (*heard == Heard::Frame) errors_in_a_row_ = 0;
  if (const auto strange = session_.take_doubt()) return doubt(*strange);
  if (*heard == Heard::Hello) {
    desk_->greeted(guest_);
    session_.expect_clock();
    return {{welcome(), clock_question()}};
  }
  if (*heard == Heard::Clock && session_.wants_clock()) return {{clock_question()}};
  return {};
}

http::Reply PushDialogue::look() {
  const SteadyTime now = desk_->steady_now();
  if (!session_.hello()) {
    if (desk_->must_leave(guest_))
      return send_away({ErrorCode::Unavailable, "type",
                        "too many programs are connected and say nothing; this one makes room"});
    if (now - begun_ < kHelloWithin) return {};
    return send_away({ErrorCode::Timeout, "type", "the first message, a hello, has not come"});
  }
  if (!session_.holds_sensor())
    return send_away({ErrorCode::Conflict, "type", "another program pushes to this sensor now"});
  if (now - heard_ > kSilentFor)
    return send_away({ErrorCode::Timeout, {}, "nothing has come for 30 s, not even the time"});
  if (asked_ && now - *asked_ < kClockEvery) return {};
  return {{clock_question()}};
}

http::Reply PushDialogue::end(const Error& why) {
  if (why.code != ErrorCode::TooLarge) return send_away(why);
  return send_away({why.code, why.context,
                    why.message + " (device.bridge.max_message_kb); send fewer bodies at once, or "
                                  "without covariances"});
}

}  // namespace

Result<std::unique_ptr<http::Dialogue>> open_dialogue(const std::shared_ptr<PushDesk>& desk,
                                                      std::string via, std::string address) {
  const auto guest = desk->connect(via);
  if (!guest) return pass(guest);
  return std::make_unique<PushDialogue>(desk, *guest, std::move(via), std::move(address));
}

}  // namespace chorus::bridge
