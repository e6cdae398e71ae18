#include "services/sensor/device/camera/grabber.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <utility>

#include "services/sensor/device/camera/restart_pause.h"

namespace chorus::camera {
namespace {

constexpr Duration kShortestPause = std::chrono::milliseconds(500);
constexpr Duration kLongestPause = std::chrono::seconds(5);
constexpr Duration kTooLate = std::chrono::milliseconds(500);
constexpr Duration kSlowest = std::chrono::seconds(1);
constexpr Duration kLost = std::chrono::seconds(5);
constexpr Duration kWorthSkipping = std::chrono::seconds(3);

}  // namespace

bool rest(const std::stop_token& stop, Duration pause) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, pause, [] { return false; });
  return !stop.stop_requested();
}

Grabber::Grabber(const CameraSettings& settings, const Clock& clock, CameraState& state,
                 Handover<Shot>& newest)
    : settings_(settings),
      clock_(clock),
      state_(state),
      newest_(newest),
      kind_(kind_of(settings.source)),
      stream_(settings.latency),
      pace_(settings.loop) {}

/// Waits until `due`, in steps, because the clock may be set meanwhile.
void Grabber::wait_for(Timestamp due, const std::stop_token& stop) {
  constexpr Duration kStep = std::chrono::milliseconds(100);
  constexpr Duration kNever = std::chrono::seconds(10);
  for (Duration left = due - clock_.now(); left > Duration::zero() && left < kNever;
       left = due - clock_.now()) {
    if (!rest(stop, std::min(left, kStep))) return;
  }
}

Timestamp Grabber::captured(const VideoMoment& taken) {
  const Timestamp arrived = clock_.now();
  if (kind_ == SourceKind::Device)
    return captured_by_driver(arrived, taken.time, settings_.latency);
  if (kind_ == SourceKind::Stream) return stream_.captured(arrived, taken.time);
  const Timestamp due = pace_.due(taken.time);
  late_ = arrived - due;
  // Looping files stay in step with other sensors.
  if (settings_.loop || late_ <= kLost) return due;
  pace_.fall_behind(late_);
  late_ = Duration{0};
  return arrived;
}

void Grabber::begin_file(Video& video) {
  over_ = pace_.begin(video.timing(), clock_.now());
  if (over_ > kWorthSkipping) video.skip_to(over_);
}

/// True for a picture that was due before the file was opened, in the middle of a round.
bool Grabber::is_over(const VideoMoment& taken) const {
  return kind_ == SourceKind::File && taken.time && *taken.time < over_;
}

/// True if the runner should get this picture: limits the rate to max_rate_hz, and to one picture a
/// second while a file is read too slowly.
bool Grabber::is_wanted(Timestamp captured) const {
  // A picture is used once this share of a step has passed, because pictures are not evenly spaced.
  constexpr double kNearly = 0.9;
  if (!given_ || captured < *given_) return true;
  const Duration since = captured - *given_;
  if (late_ > kTooLate) return since >= kSlowest;
  return seconds(since) * settings_.max_rate_hz >= kNearly;
}

Result<bool> Grabber::play(Video& video, const std::stop_token& stop) {
  constexpr int kMostDamaged = 30;
  int damaged = 0;  // in a row
  bool any = false;
  if (kind_ == SourceKind::File) begin_file(video);
  while (!stop.stop_requested()) {
    auto taken = video.next();
    if (!taken) return pass(taken);
    if (!*taken) {
      if (any) return true;
      return fail(ErrorCode::Unavailable, told_source(settings_.source),
                  "no pictures can be read from the file; is it a video?");
    }
    any = true;
    if (is_over(**taken)) continue;
    const Timestamp when = captured(**taken);
    if (late_ > kLost) return true;  // Makes run() open the file again, at the right place.
    if (kind_ == SourceKind::File) wait_for(when, stop);
    if (!is_wanted(when)) continue;
    given_ = when;
    auto picture = video.picture();
    if (!picture && ++damaged > kMostDamaged) return pass(picture);
    if (!picture) continue;  // Webcams lose one occasionally.
    damaged = 0;
    state_.picture(picture->size);
    newest_.give({std::move(*picture), when});
  }
  return false;
}

void Grabber::run(const std::stop_token& stop) {
  RestartPause pause(kShortestPause, kLongestPause);
  while (!stop.stop_requested()) {
    const auto began = std::chrono::steady_clock::now();
    auto video = open_video(settings_);
    if (video) state_.source_opened();
    const Result<bool> ended = video ? play(**video, stop) : pass(video);
    if (ended && *ended && !settings_.loop) break;
    if (ended) continue;
    state_.source_failed(to_string(ended.error()));
    video = pass(ended);  // Destroys the video: a webcam that returns needs its device free.
    if (!rest(stop, pause.after(std::chrono::steady_clock::now() - began))) break;
  }
  newest_.close();
}

}  // namespace chorus::camera
