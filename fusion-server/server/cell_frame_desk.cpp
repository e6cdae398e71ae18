#include "fusion-server/server/cell_frame_desk.h"

#include "common/resource/link_lines.h"

namespace chorus::server {
namespace {

using std::chrono::steady_clock;

constexpr auto kFresh = std::chrono::milliseconds(30);  ///< Until then the same frame is good.
constexpr auto kKept = std::chrono::seconds(2);         ///< An older answer would mislead.
/// Questions that are remembered at once; each may keep a frame of some 10 kB.
constexpr std::size_t kMost = 128;
constexpr std::size_t kLongestInstant = 20;  // digits

bool is_instant(const std::string& text) {
  return text.size() <= kLongestInstant &&
         text.find_first_not_of("0123456789") == std::string::npos;
}

}  // namespace

void CellFrameDesk::fetch(const Wish& wish) {
  auto text = ask_(wish.first, wish.second);
  const std::scoped_lock lock(mutex_);
  Frame& frame = frames_[wish];
  frame.asked = false;
  frame.at = steady_clock::now();
  if (!text) {
    frame.answer = pass(text);
    return;
  }
  http::DocumentOptions options;
  options.version = run_ + "-" + std::to_string(++version_);
  options.cache_control = "no-store";
  frame.answer = resource::other_document("application/json", std::move(*text), std::move(options));
}

void CellFrameDesk::forget_old(steady_clock::time_point now) {
  std::erase_if(frames_, [&](const auto& each) {
    return !each.second.asked && now - each.second.at > kKept;
  });
}

Result<http::DocumentPtr> CellFrameDesk::frame(const std::string& cell, const std::string& at) {
  const std::string where = "site/cells/" + cell + "/frame";
  if (!is_instant(at))
    return fail(ErrorCode::InvalidArgument, where, "at is a number of nanoseconds since 1970");
  if (lists_ && !lists_(cell))
    return fail(ErrorCode::NotFound, where, "the site has no such cell: /site/cells/ lists them");
  const auto now = steady_clock::now();
  const std::scoped_lock lock(mutex_);
  forget_old(now);
  const Wish wish{cell, at};
  if (!frames_.contains(wish) && frames_.size() >= kMost)
    return fail(ErrorCode::Unavailable, where, "too many frames are asked for: wait a second");
  Frame& frame = frames_[wish];
  const bool come = frame.at != steady_clock::time_point{};
  if (!frame.asked && now - frame.at > kFresh && (at.empty() || !come)) {
    frame.asked = true;
    worker_.post([this, wish] { fetch(wish); });
  }
  if (!come)
    return fail(ErrorCode::Unavailable, where, "the cell is being asked; ask again in a moment");
  return frame.answer;
}

void CellFrameDesk::add_routes(http::Router& router) {
  router.get("/site/cells/{cell}/frame",
             [this](const http::Request& request, const http::PathParams& params) {
               const auto at = request.query.find("at");
               return frame(params.at("cell"), at == request.query.end() ? "" : at->second);
             });
}

}  // namespace chorus::server
