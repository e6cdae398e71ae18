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

}  // namespace

struct FilmPictures::State {
  State(std::unique_ptr<Video> opened, double rate, Timestamp begin)
      : video(std::move(opened)),
        timing(video->timing()),
        clock(timing),
        rate_hz(rate),
        start(begin) {}

  std::unique_ptr<Video> video;
  FileTiming timing;
  FilmClock clock;
  double rate_hz;
  Timestamp start;
  std::optional<Timestamp> last{};

  [[nodiscard]] bool wanted(Timestamp captured) const {
    // A picture is used once this share of a step has passed, because pictures are not evenly
    // spaced.
    constexpr double kNearly = 0.9;
    return !last || seconds(captured - *last) * rate_hz >= kNearly;
  }
};

FilmPictures::FilmPictures(std::unique_ptr<State> state) : state_(std::move(state)) {}
FilmPictures::FilmPictures(FilmPictures&&) noexcept = default;
FilmPictures& FilmPictures::operator=(FilmPictures&&) noexcept = default;
FilmPictures::~FilmPictures() = default;

Result<FilmPictures> FilmPictures::open(const CameraSettings& settings, Timestamp start) {
  auto video = open_video(settings);
  if (!video) return pass(video);
  return FilmPictures(std::make_unique<State>(std::move(*video), settings.max_rate_hz, start));
}

Result<std::optional<FilmPicture>> FilmPictures::next() {
  while (true) {
    const auto moment = state_->video->next();
    if (!moment) return pass(moment);
    if (!*moment) return std::optional<FilmPicture>();
    const Duration over = state_->clock.next((*moment)->time);
    const Timestamp captured = state_->start + over;
    if (!state_->wanted(captured)) continue;
    auto picture = state_->video->picture();
    if (!picture) continue;  // The picture is damaged.
    state_->last = captured;
    return std::optional(
        FilmPicture{std::move(*picture), captured, share_of(state_->timing, over)});
  }
}

Result<FilmFrames> look_through(const Film& film, const std::stop_token& stop) {
  auto pictures = FilmPictures::open(film.settings, film.start);
  if (!pictures) return pass(pictures);
  auto looker = Looker::start(film.settings, film.command, stop);
  if (!looker) return pass(looker);
  if (film.mask) looker->want_masks();
  FilmFrames out{
      {}, looker->about().hello.name, std::string(looker->about().hello.layout->name), {}, 0};
  while (!stop.stop_requested() && out.frames.size() < kMaxFrames) {
    const auto next = pictures->next();
    if (!next) return pass(next);
    if (!*next) break;
    const FilmPicture& shown = **next;
    const std::uint64_t sequence = out.frames.size() + 1;
    auto found = looker->look(shown.picture, shown.captured, sequence, stop);
    if (!found) return pass(found);
    out.lens = found->lens;
    if (film.mask && found->mask) film.mask(shown.captured, std::move(*found->mask));
    out.people = std::max(out.people, found->bodies.size());
    out.frames.push_back(frame_of(film, shown.captured, sequence, std::move(*found)));
    if (film.progress) film.progress(shown.share);
  }
  if (!out.frames.empty()) return out;
  return fail(ErrorCode::InvalidArgument, film.settings.source,
              "no pictures can be read from the file; is it a video?");
}

}  // namespace chorus::camera
