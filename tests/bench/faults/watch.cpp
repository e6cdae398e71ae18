#include "tests/bench/faults/watch.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <iterator>
#include <mutex>
#include <thread>

#include "common/http/client.h"
#include "common/http/status.h"
#include "common/net/asio.h"
#include "common/resource/frame_resource.h"
#include "common/time/clock.h"
#include "tests/judge/statistics.h"

namespace chorus::bench {
namespace {

constexpr double kPercent = 100.0;

FusedInstant instant_of(const resource::FrameResource& frame, Timestamp received) {
  FusedInstant out{
      static_cast<std::int64_t>(frame.sequence), frame.captured, received, {}, {}, {}, {}};
  for (const auto& body : frame.bodies) {
    out.bodies.push_back(body.id);
    out.places.push_back(body.joints[index_of(JointId::SpineBase)].position);
    Located& joints = out.joints.emplace_back();
    for (std::size_t j = 0; j < kJointCount; ++j)
      if (body.joints[j].state != JointState::NotTracked) joints[j] = body.joints[j].position;
    for (const auto& joint : body.joints) {
      for (std::size_t i = 0; i < frame.sensors.size(); ++i) {
        if ((joint.contributors >> i & 1U) != 0) out.contributors.insert(frame.sensors[i]);
      }
    }
  }
  return out;
}

bool follows(const FusedInstant& before, const FusedInstant& after) {
  return after.instant > before.instant;
}

// If more frames than this are missing, they are gone, or the server restarted.
constexpr std::int64_t kMaxMissed = 60;

http::ClientRequest request_of(std::int64_t sequence) {
  return {"GET", "/frames/" + std::to_string(sequence), {{"Accept", "application/json"}}, {}};
}

}  // namespace

struct Watch::Impl {
  explicit Impl(std::uint16_t to)
      : port(to), client(io, "127.0.0.1", to), past(io, "127.0.0.1", to), timer(io) {}

  void ask() {
    http::ClientRequest request{"GET", "/frame", {{"Accept", "application/json"}}, {}};
    if (!etag.empty()) {
      request.headers.emplace_back("If-None-Match", etag);
      request.headers.emplace_back("Prefer", "wait=2");
    }
    client.send(std::move(request), std::chrono::seconds(4),
                [this](const Result<http::ClientResponse>& answer) { take(answer); });
  }

  void take(const Result<http::ClientResponse>& answer) {
    if (!answer ||
        (answer->status != http::status::kOk && answer->status != http::status::kNotModified)) {
      etag.clear();
      timer.expires_after(std::chrono::milliseconds(5));
      timer.async_wait([this](const net::error_code& stopped) {
        if (!stopped) ask();
      });
      return;
    }
    if (const auto it = answer->headers.find("etag"); it != answer->headers.end())
      etag = it->second;
    if (answer->status == http::status::kOk) keep(*answer);
    ask();
  }

  void keep(const http::ClientResponse& answer) {
    const auto frame = resource::read_frame(answer.body, resource::Format::Json);
    if (!frame) return;
    auto instant = instant_of(*frame, from_unix_ns(answer.received_ns));
    const std::scoped_lock lock(mutex);
    if (!seen.empty() && !follows(seen.back(), instant)) return;
    if (!seen.empty() && instant.sequence - seen.back().sequence <= kMaxMissed) {
      for (std::int64_t each = seen.back().sequence + 1; each < instant.sequence; ++each)
        missed.push_back({each, instant.received});
    }
    seen.push_back(std::move(instant));
    if (!fetching) fetch_next();
  }

  /// Fetches the frames that the watcher was too slow for, while the server still remembers them.
  void fetch_next() {
    fetching = !missed.empty();
    if (!fetching) return;
    const Missed next = missed.front();
    missed.pop_front();
    past.send(request_of(next.sequence), std::chrono::seconds(4),
              [this, next](const Result<http::ClientResponse>& answer) {
                const std::scoped_lock lock(mutex);
                if (answer) insert(*answer, next);
                fetch_next();
              });
  }

  /// A missed frame; it counts as received together with the frame after it.
  struct Missed {
    std::int64_t sequence = 0;
    Timestamp received;
  };

  void insert(const http::ClientResponse& answer, const Missed& which) {
    const auto frame = resource::read_frame(answer.body, resource::Format::Json);
    if (!frame) return;
    auto instant = instant_of(*frame, which.received);
    const auto after = std::ranges::lower_bound(seen, instant.instant, {}, &FusedInstant::instant);
    if (after == seen.end() || after->instant != instant.instant)
      seen.insert(after, std::move(instant));
  }

  /// Fetches a frame that is still missing, and waits for it.
  void fetch(const Missed& which, std::vector<FusedInstant>& out) const {
    const auto request = request_of(which.sequence);
    const auto answer = http::fetch({"127.0.0.1", port, request.target}, request);
    if (!answer) return;
    const auto frame = resource::read_frame(answer->body, resource::Format::Json);
    if (frame) out.push_back(instant_of(*frame, which.received));
  }

  std::uint16_t port;
  asio::io_context io{1};
  http::AsyncClient client;
  http::AsyncClient past;  ///< Asks for missed frames.
  net::Timer timer;
  std::string etag;
  mutable std::mutex mutex;  ///< Guards what follows.
  std::vector<FusedInstant> seen;
  std::deque<Missed> missed;
  bool fetching = false;  ///< A request for a missed frame is under way.
  std::jthread thread;
};

Watch::Watch(std::uint16_t port) : impl_(std::make_unique<Impl>(port)) {
  impl_->ask();
  impl_->thread = std::jthread([impl = impl_.get()] { impl->io.run(); });
}

Watch::~Watch() {
  impl_->io.stop();
  impl_->thread.join();
}

std::vector<FusedInstant> Watch::seen() const {
  std::vector<FusedInstant> seen;
  {
    const std::scoped_lock lock(impl_->mutex);
    seen = impl_->seen;
  }
  std::vector<FusedInstant> out;
  for (const FusedInstant& each : seen) {
    const std::int64_t last = out.empty() ? each.sequence - 1 : out.back().sequence;
    if (each.sequence - last <= kMaxMissed) {
      for (std::int64_t missed = last + 1; missed < each.sequence; ++missed)
        impl_->fetch({missed, each.received}, out);
    }
    out.push_back(each);
  }
  return out;
}

FusedInstant Watch::newest() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->seen.empty() ? FusedInstant{} : impl_->seen.back();
}

double Account::share_of(const std::string& sensor) const {
  const auto it = share.find(sensor);
  return it == share.end() ? 0.0 : it->second;
}

namespace {

std::vector<double> ages_of(const std::vector<FusedInstant>& part) {
  std::vector<double> out;
  for (const FusedInstant& each : part) out.push_back(seconds(each.received - each.instant));
  return out;
}

}  // namespace

Account account_of(std::span<const FusedInstant> seen, Timestamp from, Timestamp to) {
  constexpr double kSensorRate = 30.0;  // [Hz]
  std::vector<FusedInstant> part;
  std::ranges::copy_if(seen, std::back_inserter(part), [&](const FusedInstant& each) {
    return each.received >= from && each.received < to;
  });
  Account out;
  out.frames = part.size();
  out.longest_gap = seconds(to - (part.empty() ? from : part.back().received));
  if (part.size() < 2) return out;
  std::size_t with_body = 0;
  std::size_t several = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    if (i > 0)
      out.longest_gap = std::max(out.longest_gap, seconds(part[i].received - part[i - 1].received));
    with_body += part[i].bodies.empty() ? 0 : 1;
    several += part[i].bodies.size() > 1 ? 1 : 0;
    for (const std::string& name : part[i].contributors) out.share[name] += 1.0;
  }
  const double due = kSensorRate * seconds(part.back().instant - part.front().instant);
  const auto all = static_cast<std::size_t>(std::llround(due)) + 1;
  out.lost = all - std::min(all, with_body);
  const auto frames = static_cast<double>(part.size());
  out.hz = frames / seconds(to - from);
  out.age_p50 = percentile(ages_of(part), 0.5);
  out.age_p90 = percentile(ages_of(part), 0.9);
  out.several_percent = kPercent * static_cast<double>(several) / frames;
  for (auto& [name, share] : out.share) share *= kPercent / frames;
  return out;
}

double recovery(std::span<const FusedInstant> seen, Timestamp since,
                const std::vector<std::string>& sensors) {
  constexpr Duration kSteady = std::chrono::seconds(1);
  const auto whole = [&](const FusedInstant& each) {
    return !each.bodies.empty() && std::ranges::all_of(sensors, [&](const std::string& name) {
      return each.contributors.contains(name);
    });
  };
  const FusedInstant* begun = nullptr;
  for (const FusedInstant& each : seen) {
    if (each.received < since) continue;
    if (!whole(each)) {
      begun = nullptr;
    } else if (begun == nullptr) {
      begun = &each;
    }
    if (begun != nullptr && each.received - begun->received >= kSteady)
      return seconds(begun->received - since);
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace chorus::bench
