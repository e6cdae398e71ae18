#include "fusion-server/foxglove/viewer_dialogue.h"

#include <iterator>
#include <utility>

#include "fusion-server/foxglove/messages.h"

namespace chorus::foxglove {
namespace {

/// More than the newest messages of a hundred sensors and the fused ones.
constexpr std::size_t kMaxUnread = 32u << 20;
constexpr std::size_t kMaxSubscriptions = 1000;

}  // namespace

ViewerDialogue::ViewerDialogue(const Desk& desk, std::string name, std::string session)
    : desk_(desk), name_(std::move(name)), session_(std::move(session)) {}

http::Reply ViewerDialogue::hear(std::string_view message) {
  http::Reply reply;
  const auto wishes = wishes_of(message);
  if (!wishes) {
    reply.messages.push_back(warning(wishes.error().message));
    return reply;
  }
  for (const Wish& wish : *wishes) {
    if (wish.over) {
      subscriptions_.erase(wish.subscription);
    } else if (desk_.channel(wish.channel).id == 0) {
      reply.messages.push_back(warning("there is no channel " + std::to_string(wish.channel)));
    } else if (subscriptions_.size() < kMaxSubscriptions) {
      subscriptions_[wish.subscription] = {wish.channel, 0};
    }
  }
  http::Reply news = look();
  std::move(news.messages.begin(), news.messages.end(), std::back_inserter(reply.messages));
  reply.binary = std::move(news.binary);
  return reply;
}

http::Reply ViewerDialogue::look() {
  http::Reply reply;
  if (!std::exchange(greeted_, true)) reply.messages.push_back(server_info(name_, session_));
  if (const auto fresh = desk_.channels_after(advertised_); !fresh.empty()) {
    reply.messages.push_back(advertise(fresh));
    advertised_ = fresh.back().id;
  }
  for (auto& [id, subscription] : subscriptions_) {
    const Channel channel = desk_.channel(subscription.channel);
    if (!channel.newest || channel.version == subscription.version) continue;
    subscription.version = channel.version;
    reply.binary.push_back(message_bytes(id, *channel.newest));
  }
  return reply;
}

http::Reply ViewerDialogue::end(const Error& why) { return {{warning(why.message)}, true}; }

void add_route(http::Router& router, const Desk& desk, const std::string& name,
               const std::string& session) {
  http::DialogueRoute route;
  route.open = [&desk, name,
                session](const std::string&) -> Result<std::unique_ptr<http::Dialogue>> {
    return std::make_unique<ViewerDialogue>(desk, name, session);
  };
  route.protocol = std::string(kSubprotocol);
  route.max_unread = kMaxUnread;
  route.role = http::Role::Read;
  route.wake = desk.wake();
  router.dialogue("/foxglove", std::move(route));
}

}  // namespace chorus::foxglove
