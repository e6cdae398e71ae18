// A conversation without a socket, driven by hand.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "common/http/conversation.h"

namespace chorus::http {

/// Stands in for the code around a conversation: carries out its reactions at once, as far as the
/// test permits.
class ConversationTest : public ::testing::Test {
 protected:
  ConversationTest() {
    config_.clock = std::make_shared<FakeClock>(from_unix_ns(1'700'000'000'000'000'000));
    config_.limits.max_header_bytes = 256;
    auto router = std::make_shared<Router>();
    router->live("/frame", frame_);
    router->get("/vital", [](const Request&, const PathParams&) -> Result<DocumentPtr> {
      return make_document("text/plain", "well", {"1"});
    });
    router->vital("/vital");
    router->action(Method::Post, "/do", [](const Request& request, const PathParams&) {
      return Result<ActionResult>(
          ActionResult{200, make_document("text/plain", std::string(request.body), {"1"})});
    });
    responder_ = std::make_unique<Responder>(config_, router);
    talk_ = std::make_unique<Conversation>(
        ConversationContext{config_, *responder_, counters_, stopping_},
        Peer{true, "127.0.0.1", 80}, [this](const std::string&) { return room_for_others_; });
    publish(1);
  }

  void publish(int version) {
    frame_->publish(
        make_document("application/json", std::to_string(version), {std::to_string(version)}));
  }
  void begin() { obey(talk_->begin(now_)); }
  void say(std::string_view bytes) {
    ASSERT_TRUE(reading_) << "nobody listens";
    while (!bytes.empty() && reading_) {
      const auto room = talk_->room();
      const std::size_t size = std::min(room.size(), bytes.size());
      std::copy_n(bytes.begin(), size, room.begin());
      bytes.remove_prefix(size);
      reading_ = false;
      obey(talk_->received(size, now_));
    }
    ahead_ = bytes;
  }
  void obey(const Orders& orders) {
    closed_ = closed_ || orders.close;
    half_closed_ = half_closed_ || orders.half_close;
    upgraded_ = upgraded_ || orders.upgrade;
    if (orders.stop_waiting) waiting_ = false;
    if (orders.close) return;
    reading_ = reading_ || orders.read;
    settling_ = settling_ || orders.settle;
    if (orders.write) {
      writing_ = true;
      if (!stalled_) finish_write();
    }
    if (orders.settle && !stalled_) settle();
    if (!orders.wait) return;
    waiting_ = true;
    if (publish_before_look_) publish(9);
    obey(talk_->look(now_));
  }
  void finish_write() {
    std::size_t size = 0;
    for (const std::string_view part : talk_->output()) {
      heard_ += part;
      size += part.size();
    }
    writing_ = false;
    obey(talk_->sent(size, now_));
  }
  void settle() {
    settling_ = false;
    obey(talk_->settled(now_));
  }
  void wake() {
    ASSERT_TRUE(waiting_);
    waiting_ = false;
    obey(talk_->woken(now_));
  }
  void pass(std::chrono::seconds time) {
    now_ += time;
    if (talk_->deadline() <= now_) obey(talk_->expired(now_));
  }
  [[nodiscard]] std::string heard() { return std::exchange(heard_, {}); }

  ServerConfig config_;
  AtomicCounters counters_;
  bool stopping_ = false;
  bool room_for_others_ = true;
  std::shared_ptr<LiveDocument> frame_ = std::make_shared<LiveDocument>();
  std::unique_ptr<Responder> responder_;
  std::unique_ptr<Conversation> talk_;
  SteadyTime now_{std::chrono::hours(1)};
  std::string heard_;
  std::string_view ahead_;
  bool reading_ = false, writing_ = false, settling_ = false, waiting_ = false;
  bool closed_ = false, half_closed_ = false, upgraded_ = false;
  bool stalled_ = false;              ///< The client does not read.
  bool publish_before_look_ = false;  ///< A publication comes between each wait and its look().
};

}  // namespace chorus::http
