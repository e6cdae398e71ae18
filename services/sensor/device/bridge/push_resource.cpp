#include "services/sensor/device/bridge/push_resource.h"

#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/http/status.h"
#include "common/resource/link_lines.h"
#include "services/sensor/device/bridge/push_dialogue.h"

namespace chorus::bridge {
namespace {

using Json = nlohmann::json;
using http::PathParams;
using http::Request;

constexpr double kMillisecond = 1e3;

http::DocumentPtr json_document(const Json& json, std::string version) {
  http::DocumentOptions options;
  options.version = std::move(version);
  options.cache_control = "no-store";
  return resource::other_document("application/json",
                                  json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n",
                                  std::move(options));
}

Json pusher_json(const PushStatus& status) {
  Json json{{"name", status.pusher->name},       {"layout", status.pusher->layout},
            {"via", status.pusher->via},         {"address", status.pusher->address},
            {"since", to_iso8601(status.since)}, {"frames", status.frames},
            {"refused", status.refused},         {"leftOut", status.left_out},
            {"lastError", status.last_error}};
  if (!status.doubt.empty()) json["doubt"] = status.doubt;
  if (status.clock) {
    json["clockOffsetMilliseconds"] = -seconds(status.clock->ours_minus_theirs) * kMillisecond;
    json["clockUncertaintyMilliseconds"] = seconds(status.clock->uncertainty) * kMillisecond;
  }
  return json;
}

http::DocumentPtr status_document(const PushDesk& desk) {
  const PushStatus status = desk.status();
  Json layouts = Json::array();
  for (const layout::Layout* layout : layout::layouts()) layouts.push_back(layout->name);
  Json json{{"sensor", desk.options().sensor.str()},
            {"state", status.state},
            {"reason", status.reason},
            {"layouts", std::move(layouts)}};
  if (status.pusher) json["pusher"] = pusher_json(status);
  return json_document(json, std::to_string(to_unix_ns(desk.now())));
}

/// Serves pushers that push by POST.  Keeps the session of the last one, so that its clock and its
/// frame count continue from one request to the next.  Used on the server's thread.
class PostBox {
 public:
  explicit PostBox(std::shared_ptr<PushDesk> desk) : desk_(std::move(desk)) {}

  [[nodiscard]] Result<http::ActionResult> take(const Request& request);

 private:
  struct Outcome {
    std::uint64_t taken = 0;
    std::uint64_t left_out = 0;
    std::uint64_t refused = 0;
    std::optional<Error> first;
    std::string doubt;
  };
  [[nodiscard]] Result<void> greet(std::string_view line);
  /// `line_number`: counts the lines that are not empty from 1, the hello's.
  void hear(std::string_view line, std::size_t line_number, Outcome& outcome);

  std::shared_ptr<PushDesk> desk_;
  std::unique_ptr<PushSession> session_;
};

/// Takes the first line that is not empty off the text; returns it without its line end.
std::string_view next_line(std::string_view& text) {
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (!line.empty()) return line;
  }
  return {};
}

/// Handles the first line of each request, which must be a hello.  A hello of another pusher
/// begins a new session.
Result<void> PostBox::greet(std::string_view line) {
  const auto read = read_push_message(line, nullptr);
  if (!read) return pass(read);
  const auto* hello = std::get_if<Hello>(&*read);
  if (hello == nullptr) {
    return fail(ErrorCode::Malformed, "type",
                "the first line of a POST is the hello; frames and clock answers follow");
  }
  std::unique_ptr<PushSession> fresh;
  const bool same = session_ && session_->hello() && session_->hello()->name == hello->name;
  if (!same) fresh = std::make_unique<PushSession>(desk_, "HTTP POST", "");
  const auto heard = (same ? session_ : fresh)->hear(line);
  if (!heard && same && session_->lost()) session_.reset();
  if (!heard) return pass(heard);
  if (!same) session_ = std::move(fresh);
  return {};
}

void PostBox::hear(std::string_view line, std::size_t line_number, Outcome& outcome) {
  const auto heard = session_->hear(line);
  if (!heard) {
    ++outcome.refused;
    if (!outcome.first) outcome.first = heard.error();
    if (outcome.first->context.empty())
      outcome.first->context = "line " + std::to_string(line_number);
    return;
  }
  if (*heard == Heard::Frame) ++outcome.taken;
  if (*heard == Heard::LeftOut) ++outcome.left_out;
  if (const auto doubt = session_->take_doubt()) outcome.doubt = to_string(*doubt);
}

Result<http::ActionResult> PostBox::take(const Request& request) {
  std::string_view body = request.body;
  if (const auto ok = greet(next_line(body)); !ok) return pass(ok);
  Outcome outcome;
  std::size_t number = 1;
  for (auto line = next_line(body); !line.empty() && !session_->lost(); line = next_line(body))
    hear(line, ++number, outcome);
  if (session_->lost()) session_.reset();
  if (outcome.first && outcome.taken == 0) return tl::unexpected<Error>(*outcome.first);
  Json json{{"sensor", desk_->options().sensor.str()},
            {"taken", outcome.taken},
            {"leftOut", outcome.left_out},
            {"refused", outcome.refused}};
  if (outcome.first) json["reason"] = to_string(*outcome.first);
  if (!outcome.doubt.empty()) json["doubt"] = outcome.doubt;
  return http::ActionResult{http::status::kOk,
                            json_document(json, std::to_string(to_unix_ns(desk_->now())))};
}

}  // namespace

void add_push_routes(http::Router& router, const std::shared_ptr<PushDesk>& desk) {
  router.get("/push", [desk](const Request&, const PathParams&) -> Result<http::DocumentPtr> {
    return status_document(*desk);
  });
  router.action(http::Method::Post, "/push",
                [box = std::make_shared<PostBox>(desk)](const Request& request, const PathParams&) {
                  return box->take(request);
                });
  const auto open = [desk](const std::string& address) {
    return open_dialogue(desk, "WebSocket", address);
  };
  router.dialogue("/push", {open, "chorus.push", desk->options().settings.max_message_bytes});
}

}  // namespace chorus::bridge
