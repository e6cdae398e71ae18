#include "services/sensor/device/camera/film.h"

#include <algorithm>
#include <utility>

#include "services/sensor/device/camera/video.h"

namespace chorus::camera {
namespace {

constexpr std::size_t kMaxFrames = 1'000'000;  // Nine hours at 30 Hz.

/// The capture times of pictures, counted from the file's first one.
class FilmClock {
 public:
  explicit FilmClock(const FileTiming& timing) : step_(timing.step) {}
  /// The time of the next picture.  Some containers state no times for their last pictures.
  Duration next(std::optional<Duration> told) {
    if (!begun_) {
      begun_ = true;
      first_ = told.value_or(Duration{0});
      return last_;
    }
    const Duration since = told ? *told - first_ : Duration{0};
    last_ = since > last_ ? since : last_ + step_;
    return last_;
  }

 private:
  Duration step_;
  Duration first_{0};
  Duration last_{0};
  bool begun_ = false;
};

double share_of(const FileTiming& timing, Duration over) {
  if (!timing.length || *timing.length <= Duration{0}) return 0.0;
  return std::min(1.0, seconds(over) / seconds(*timing.length));
}

SensorFrame frame_of(const Film& film, Timestamp captured, std::uint64_t sequence, Found found) {
  return {film.sensor, sequence, captured, captured, std::move(found.bodies), found.floor};
}

bool wanted(const Film& film, const FilmFrames& out, Timestamp captured) {
  // A picture is used once this share of a step has passed, because pictures are not evenly spaced.
  constexpr double kNearly = 0.9;
  return out.frames.empty() ||
         seconds(captured - out.frames.back().captured) * film.settings.max_rate_hz >= kNearly;
}

}  // namespace

Result<FilmFrames> look_through(const Film& film, const std::stop_token& stop) {
  auto video = open_video(film.settings);
  if (!video) return pass(video);
  auto looker = Looker::start(film.settings, film.command, stop);
  if (!looker) return pass(looker);
  const FileTiming timing = (*video)->timing();
  FilmClock clock(timing);
  FilmFrames out{
      {}, looker->about().hello.name, std::string(looker->about().hello.layout->name), {}, 0};
  while (!stop.stop_requested() && out.frames.size() < kMaxFrames) {
    const auto moment = (*video)->next();
    if (!moment) return pass(moment);
    if (!*moment) break;
    const Duration over = clock.next((*moment)->time);
    const Timestamp captured = film.start + over;
    if (!wanted(film, out, captured)) continue;
    const auto picture = (*video)->picture();
    if (!picture) continue;  // The picture is damaged.
    auto found = looker->look(*picture, captured, out.frames.size() + 1, stop);
    if (!found) return pass(found);
    out.lens = found->lens;
    out.people = std::max(out.people, found->bodies.size());
    out.frames.push_back(frame_of(film, captured, out.frames.size() + 1, std::move(*found)));
    if (film.progress) film.progress(share_of(timing, over));
  }
  if (!out.frames.empty()) return out;
  return fail(ErrorCode::InvalidArgument, film.settings.source,
              "no pictures can be read from the file; is it a video?");
}

}  // namespace chorus::camera
