#include "services/ctl/video_import.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/base/config_reader.h"
#include "common/base/file.h"
#include "services/sensor/device/camera/film.h"
#include "services/sensor/device/camera/shipped_runner.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kMaxLensBytes = 1u << 20;

/// "cam01.mp4: 43 %, 12 s left": redrawn on a terminal; elsewhere printed at every tenth.
class Progress {
 public:
  explicit Progress(std::string name) : name_(std::move(name)) {}

  void operator()(double share) {
    const auto now = std::chrono::steady_clock::now();
    if (!begun_) {
      begun_ = now;
      first_ = share;
      return;  // the runner's start-up time tells nothing
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

/// The text of only the lens, as JSON.
Result<std::string> lens_text(const std::string& file) {
  const auto text = read_file(file, kMaxLensBytes);
  if (!text) return pass(text);
  auto root = ConfigReader::parse(*text, file);
  if (!root) return pass(root);
  if (!root->has("device")) return root->text();
  const std::string own = root->child("device").child("camera").text("intrinsics");
  if (!own.empty()) return own;
  return fail(ErrorCode::InvalidArgument, file,
              "is a sensor's configuration without device.camera.intrinsics");
}

/// The settings that a sensor would read from its section device.camera.
Result<camera::CameraSettings> settings_for(const fs::path& video, const VideoImport& how,
                                            std::size_t index) {
  nlohmann::json section{{"source", video.string()},
                         {"model", how.model},
                         {"loop", false},
                         {"max_rate_hz", how.rate_hz}};
  if (!how.lenses.empty()) {
    const auto lens = lens_text(how.lenses[how.lenses.size() == 1 ? 0 : index]);
    if (!lens) return pass(lens);
    section["intrinsics"] = nlohmann::json::parse(*lens, nullptr, false);
  }
  auto reader = ConfigReader::parse(section.dump(), "--intrinsics");
  if (!reader) return pass(reader);
  auto settings = camera::read_camera_settings(*reader);
  if (auto ok = reader->finish(); !ok) return pass(ok);
  return settings;
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
  Progress progress(file.filename().string());
  auto film = camera::look_through({std::move(*settings), std::move(*command), *sensor,
                                    options.start, [&](double share) { progress(share); }});
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
  if (how.lenses.size() > 1 && how.lenses.size() != inputs.size())
    return fail(ErrorCode::InvalidArgument, "--intrinsics",
                fmt::format("takes one lens for all, or one for each of the {} videos, not {}",
                            inputs.size(), how.lenses.size()));
  return importers::import_recordings(
      inputs, options,
      [&](const fs::path& file, const importers::ImportOptions& own, std::size_t index) {
        return import_one(file, how, index, own);
      });
}

}  // namespace chorus::ctl
