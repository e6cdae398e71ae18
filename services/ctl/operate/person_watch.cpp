#include "services/ctl/operate/person_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/duration.h"
#include "common/base/json.h"
#include "common/client/live_poll.h"
#include "common/client/service_client.h"
#include "common/http/client.h"
#include "common/time/timestamp.h"

namespace chorus::ctl {
namespace {

constexpr double kSway = 0.06;            // Farthest from the newest place of who stands still [m].
constexpr std::size_t kEnoughFrames = 5;  // Smallest number of frames.

using Take = std::function<Result<bool>(const nlohmann::json& frame)>;

class FrameWatch {
 public:
  FrameWatch(const http::Url& server, tls::Trust trust, const Take& take)
      : take_(take),
        poll_(io_, server, {"/frame", "application/json", {}, std::move(trust)},
              {[this](const http::ClientResponse& answer) { deliver(answer); },
               [this](const Error& error, int status) { failed(error, status); }}) {}

  Result<bool> run(double seconds) {
    poll_.start();
    io_.run_for(from_seconds(seconds));
    poll_.stop();
    if (failure_) return tl::unexpected<Error>(*failure_);
    return done_;
  }

 private:
  void deliver(const http::ClientResponse& answer) {
    if (done_ || failure_) return;
    const auto frame = parse_json(answer.body, {.bytes = answer.body.size()});
    if (!frame) return end_with(frame.error());
    // A server without ETags may send the same frame again.
    const std::string captured = client::text_at(*frame, "captured");
    if (std::exchange(newest_, captured) == captured) return;
    const auto done = take_(*frame);
    if (!done) return end_with(done.error());
    done_ = *done;
    if (done_) io_.stop();
  }
  void failed(Error error, int status) {
    if (status == 0) error.message += "; is chorus-fusion running there?";
    end_with(std::move(error));
  }
  void end_with(Error why) {
    if (!failure_ && !done_) failure_ = std::move(why);
    io_.stop();
  }

  const Take& take_;
  asio::io_context io_{1};
  client::LivePoll poll_;
  std::string newest_;
  bool done_ = false;
  std::optional<Error> failure_;
};

Eigen::Vector2d on_floor(const nlohmann::json& joints, const std::string& name) {
  const auto& joint = client::part_at(joints, name.c_str());
  return {client::number_at(joint, "x"), client::number_at(joint, "z")};
}

}  // namespace

Result<bool> watch_frames(const std::string& server, double seconds, const Take& take) {
  const auto url = http::parse_url(server);
  if (!url) return pass(url);
  auto trust = client::authorities();
  if (!trust) return pass(trust);
  return FrameWatch(*url, std::move(*trust), take).run(seconds);
}

Result<Eigen::Vector2d> place_in(const nlohmann::json& frame, std::string_view joint) {
  const auto& bodies = client::part_at(frame, "bodies");
  if (bodies.empty()) return fail(ErrorCode::NotFound, "origin", "nobody is seen");
  if (bodies.size() > 1)
    return fail(ErrorCode::Conflict, "origin",
                "more than one person is seen; only the one who shows the marks may be");
  const auto& joints = client::part_at(bodies.front(), "joints");
  const Eigen::Vector2d place =
      joint == kFeet
          ? Eigen::Vector2d((on_floor(joints, "FootLeft") + on_floor(joints, "AnkleLeft") +
                             on_floor(joints, "FootRight") + on_floor(joints, "AnkleRight")) /
                            4.0)
          : on_floor(joints, std::string(joint));
  if (!place.allFinite())
    return fail(ErrorCode::NotFound, "origin", std::string(joint) + " is not seen");
  return place;
}

double seconds_of(const nlohmann::json& frame) {
  const auto captured = parse_iso8601(client::text_at(frame, "captured", ""));
  return captured ? chorus::seconds(captured->time_since_epoch())
                  : std::numeric_limits<double>::quiet_NaN();
}

std::optional<Eigen::Vector2d> Standstill::take(const Eigen::Vector2d& place, double at) {
  if (!std::isfinite(at)) return std::nullopt;
  if (!seen_.empty() && at <= seen_.back().at) return std::nullopt;
  seen_.push_back({place, at});
  const auto moved = std::find_if(seen_.rbegin(), seen_.rend(), [&](const Seen& each) {
    return (each.place - place).norm() > kSway;
  });
  seen_.erase(seen_.begin(), moved.base());
  if (seen_.size() < kEnoughFrames || at - seen_.front().at < length_) return std::nullopt;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Seen& each : seen_) mean += each.place / static_cast<double>(seen_.size());
  const bool new_place = std::ranges::all_of(
      before_, [&](const Eigen::Vector2d& other) { return (other - mean).norm() >= apart_; });
  return new_place ? std::optional(mean) : std::nullopt;
}

}  // namespace chorus::ctl
