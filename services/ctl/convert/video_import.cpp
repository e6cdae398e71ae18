#include "services/ctl/convert/video_import.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "services/ctl/calibrate/lens_file.h"
#include "services/sensor/device/camera/film.h"
#include "services/sensor/device/camera/shipped_runner.h"
#include "services/sensor/device/camera/video.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

/// Shows "cam01.mp4: 43 %, 12 s left": redrawn on a terminal, elsewhere printed at every 10 %.
class ImportProgress {
 public:
  explicit ImportProgress(std::string name) : name_(std::move(name)) {}

  void operator()(double share) {
    const auto now = std::chrono::steady_clock::now();
    if (!begun_) {
      begun_ = now;
      first_ = share;
      return;  // the rate so far only reflects the runner's start
    }
    const int percent = static_cast<int>(100.0 * share);
    if (percent / (terminal_ ? 1 : 10) == told_) return;
    told_ = percent / (terminal_ ? 1 : 10);
    const double since = std::chrono::duration<double>(now - *begun_).count();
    const double left = share > first_ ? since * (1.0 - share) / (share - first_) : 0.0;
    std::cerr << (terminal_ ? "\r\033[K" : "") << name_
              << fmt::format(": {} %, {:.0f} s left", percent, std::ceil(left))
              << (terminal_ && share < 1.0 ? "" : "\n") << std::flush;
  }
  void end() const {
    if (terminal_ && told_ >= 0) std::cerr << "\r\033[K" << std::flush;
  }

 private:
  std::string name_;
  bool terminal_ = isatty(STDERR_FILENO) == 1;
  std::optional<std::chrono::steady_clock::time_point> begun_;
  double first_ = 0.0;
  int told_ = -1;
};

/// The settings that a sensor would read from its section device.camera.
Result<camera::CameraSettings> settings_for(const fs::path& video, const VideoImport& how,
                                            std::size_t index) {
  auto settings = Result<camera::CameraSettings>(camera::CameraSettings());
  if (!how.lenses.empty())
    settings = read_lens_file(how.lenses[how.lenses.size() == 1 ? 0 : index]);
  if (!settings) return pass(settings);
  settings->source = video.string();
  settings->model = how.model;
  settings->loop = false;
  settings->max_rate_hz = how.rate_hz;
  return settings;
}

/// Looks at the beginning of every input before the work begins, because the runner may take
/// minutes for each.
Result<void> check_inputs(const std::vector<fs::path>& inputs, const VideoImport& how,
                          const importers::ImportOptions& options) {
  std::set<SensorId> sensors;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    std::error_code ignored;
    if (fs::file_size(inputs[i], ignored) == 0) continue;  // the others are imported without it
    const auto sensor = importers::sensor_for(inputs[i], options);
    if (!sensor) return pass(sensor);
    if (!sensors.insert(*sensor).second)
      return fail(ErrorCode::Conflict, sensor->str(),
                  "is the sensor of two inputs, since sensors are named after their files; rename "
                  "one, or import one take at a time");
    const auto settings = settings_for(inputs[i], how, i);
    if (!settings) return pass(settings);
    auto video = camera::open_video(*settings);
    if (video) {
      const auto moment = (*video)->next();
      if (moment && *moment) continue;
      video = fail(ErrorCode::InvalidArgument, inputs[i].string(),
                   "no pictures can be read from the file; is it a video?");
    }
    Error error = video.error();
    if (inputs[i].extension() == ".json") error.message += " Each lens needs its own --intrinsics.";
    return tl::unexpected<Error>(std::move(error));
  }
  return {};
}

Result<record::FrameRecording> import_one(const fs::path& file, const VideoImport& how,
                                          std::size_t index,
                                          const importers::ImportOptions& options) {
  const auto sensor = importers::sensor_for(file, options);
  if (!sensor) return pass(sensor);
  auto settings = settings_for(file, how, index);
  if (!settings) return pass(settings);
  auto command = camera::runner_command(*settings);
  if (!command) return pass(command);
  ImportProgress progress(file.filename().string());
  camera::Film looked{std::move(*settings), std::move(*command), *sensor, options.start,
                      [&](double share) { progress(share); }};
  if (how.mask)
    looked.mask = [&](Timestamp captured, camera::PersonMask mask) {
      how.mask(*sensor, captured, std::move(mask));
    };
  auto film = camera::look_through(looked);
  progress.end();
  if (!film) return pass(film);
  record::FrameRecording recording;
  recording.sensor = *sensor;
  recording.device = fmt::format("camera with {}", film->runner);
  recording.intrinsics = film->lens.camera;
  recording.floor = options.floor;
  recording.notes = {{"origin", file.filename().string()},
                     {"layout", film->layout},
                     {"time", "seconds of the video count from " + to_iso8601(options.start)}};
  recording.frames = std::move(film->frames);
  for (SensorFrame& frame : recording.frames) {
    if (options.floor) frame.floor = options.floor;
  }
  return recording;
}

}  // namespace

Result<importers::ImportedSet> import_videos(const std::vector<fs::path>& inputs,
                                             const importers::ImportOptions& options,
                                             const VideoImport& how) {
  if (auto ok = check_lens_count(how.lenses, inputs.size()); !ok) return pass(ok);
  if (auto ok = check_inputs(inputs, how, options); !ok) return pass(ok);
  return importers::import_recordings(
      inputs, options,
      [&](const fs::path& file, const importers::ImportOptions& own, std::size_t index) {
        return import_one(file, how, index, own);
      });
}

}  // namespace chorus::ctl
