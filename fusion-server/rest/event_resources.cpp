#include "fusion-server/rest/event_resources.h"

#include <algorithm>
#include <utility>

#include "common/base/parse.h"

namespace chorus::rest {

resource::Node event_node(const journal::Event& event) {
  resource::Node node{"#" + std::to_string(event.id), {"Event"}, {}};
  auto& out = node.properties;
  out.emplace_back("eventId", std::to_string(event.id));
  out.emplace_back("time", event.time);
  out.emplace_back("kind", event.kind);
  if (!event.about.empty()) out.emplace_back("about", event.about);
  out.emplace_back("severity", std::string(journal::name_of(event.severity)));
  out.emplace_back("message", event.message);
  if (!event.advice.empty()) out.emplace_back("advice", event.advice);
  return node;
}

/// The log behind a lock.
class EventResources::Kept final : public http::LoggedEvents {
 public:
  Kept(std::uint64_t first, resource::Place place) : log_(first), place_(std::move(place)) {}

  /// Keeps the events; returns those that were not left out.
  std::vector<journal::Event> add(const std::vector<journal::Event>& events, Timestamp now) {
    const std::scoped_lock lock(mutex_);
    std::vector<journal::Event> kept;
    log_.age(now);
    for (const journal::Event& event : events) {
      if (log_.add(event)) kept.push_back(log_.all().back());
    }
    return kept;
  }

  [[nodiscard]] std::vector<journal::Event> all_after(std::uint64_t id) const {
    const std::scoped_lock lock(mutex_);
    const auto& all = log_.all();
    return {std::ranges::upper_bound(all, id, {}, &journal::Event::id), all.end()};
  }

  [[nodiscard]] std::optional<One> after(std::uint64_t id) const override {
    const std::scoped_lock lock(mutex_);
    const auto next = log_.after(id);
    if (!next) return std::nullopt;
    std::string json = resource::write(event_node(*next), resource::Format::Json, place_);
    std::erase(json, '\n');  // It is one line of the stream; in strings it is escaped.
    return One{next->id, std::move(json)};
  }

 private:
  mutable std::mutex mutex_;
  journal::EventLog log_;
  resource::Place place_;
};

EventResources::EventResources(service::Serving serving, std::uint64_t first)
    : serving_(std::move(serving)),
      live_(std::make_shared<http::LiveDocument>()),
      kept_(std::make_shared<Kept>(first, serving_.place("events"))) {
  live_->publish(document(0));
}

std::vector<journal::Event> EventResources::look(journal::Glimpse glimpse) {
  const Timestamp now = glimpse.time;
  auto events = kept_->add(witness_.compare(std::move(glimpse)), now);
  if (!events.empty()) live_->publish_lazily([this] { return document(0); });
  return events;
}

http::DocumentPtr EventResources::document(std::uint64_t after) const {
  resource::Node node{"", {"EventList"}, {}};
  std::vector<resource::Node> members;
  std::uint64_t newest = after;
  for (const journal::Event& event : kept_->all_after(after)) {
    members.push_back(event_node(event));
    newest = event.id;
  }
  node.properties.emplace_back("title", std::string("events of the last day"));
  node.properties.emplace_back("events", std::move(members));
  http::DocumentOptions options;
  options.version =
      serving_.run + "-" + std::to_string(newest) + "-" + std::to_string(members.size());
  return resource::document_of(std::move(node), std::move(options), serving_.place("events"));
}

Result<http::DocumentPtr> EventResources::list(const http::Request& request) const {
  const auto after = request.query.find("after");
  const auto id = after == request.query.end() ? std::optional<std::uint64_t>()
                                               : parse_number<std::uint64_t>(after->second);
  if (id) return document(*id);
  return fail(ErrorCode::InvalidArgument, "after", "the eventId of the last event that you know");
}

void EventResources::add_routes(http::Router& router) {
  router.live("/events", live_);
  router.logged("/events", kept_);
  router.by_query(
      "/events", "after",
      [this](const http::Request& request, const http::PathParams&) { return list(request); });
}

}  // namespace chorus::rest
