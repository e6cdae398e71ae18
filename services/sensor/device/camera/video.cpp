#include "services/sensor/device/camera/video.h"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace chorus::camera {
namespace {

// Longest wait for opening a stream, and for its next picture [ms].
constexpr int kPatienceMs = 5000;
constexpr double kUsualRate = 30.0;
constexpr int kSmallWebcam = 640;  // Wider pictures are fast enough only if compressed.

Duration since_boot() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::chrono::seconds(now.tv_sec) + Duration(now.tv_nsec);
}

/// Asks for the configured mode; a webcam uses the nearest mode that it has.
void ask_webcam(cv::VideoCapture& capture, const CameraSettings& settings) {
  if (settings.width > kSmallWebcam)
    capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
  if (settings.width > 0) capture.set(cv::CAP_PROP_FRAME_WIDTH, settings.width);
  if (settings.height > 0) capture.set(cv::CAP_PROP_FRAME_HEIGHT, settings.height);
  if (settings.rate_hz > 0.0) capture.set(cv::CAP_PROP_FPS, settings.rate_hz);
  capture.set(cv::CAP_PROP_BUFFERSIZE, 2);
}

/// Clockwise quarter turns that a player makes before it shows the pictures.  OpenCV before 4.7
/// tells the angle anticlockwise (and turns phone videos upside down if it is left to turn them).
int quarter_turns_of(const cv::VideoCapture& capture) {
  constexpr bool kAnticlockwise = CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7;
  const double told = capture.get(cv::CAP_PROP_ORIENTATION_META);
  if (!(told > -1e4 && told < 1e4)) return 0;
  const auto quarters = static_cast<int>(std::lround(told / 90.0));
  return ((kAnticlockwise ? -quarters : quarters) % 4 + 4) % 4;
}

/// Turns pictures in place, clockwise.
void turn(cv::Mat& pixels, int quarters) {
  constexpr std::array kTurns{cv::ROTATE_90_CLOCKWISE, cv::ROTATE_180,
                              cv::ROTATE_90_COUNTERCLOCKWISE};
  if (quarters == 0) return;
  cv::Mat turned;
  cv::rotate(pixels, turned, kTurns[static_cast<std::size_t>(quarters) - 1]);
  pixels = turned;
}

class OpenCvVideo final : public Video {
 public:
  OpenCvVideo(cv::VideoCapture capture, std::string source)
      : capture_(std::move(capture)), source_(std::move(source)), kind_(kind_of(source_)) {
    if (kind_ == SourceKind::Device) return;  // a webcam's driver delivers them upright
    quarters_ = quarter_turns_of(capture_);
    capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0.0);
  }

  [[nodiscard]] Result<std::optional<VideoMoment>> next() override;
  [[nodiscard]] Result<Picture> picture() override;
  [[nodiscard]] FileTiming timing() const override;
  void skip_to(Duration position) override {
    capture_.set(cv::CAP_PROP_POS_MSEC, seconds(position) * 1e3);
  }

 private:
  [[nodiscard]] std::optional<Duration> time_of_picture() const;

  cv::VideoCapture capture_;
  std::string source_;
  SourceKind kind_;
  int quarters_ = 0;  ///< Clockwise quarter turns that the file or stream asks for.
};

std::optional<Duration> OpenCvVideo::time_of_picture() const {
  const double position = capture_.get(cv::CAP_PROP_POS_MSEC);
  if (kind_ == SourceKind::Device) {
    if (position <= 0.0) return std::nullopt;
    return since_boot() - from_seconds(position * 1e-3);
  }
  if (position < 0.0) return std::nullopt;
  return from_seconds(position * 1e-3);
}

Result<std::optional<VideoMoment>> OpenCvVideo::next() {
  try {
    if (capture_.grab()) return VideoMoment{time_of_picture()};
  } catch (const cv::Exception& problem) {
    return fail(ErrorCode::Io, told_source(source_), problem.what());
  }
  if (kind_ == SourceKind::File) return std::nullopt;
  return fail(ErrorCode::Unavailable, told_source(source_),
              kind_ == SourceKind::Device ? "the camera gives no more pictures; is it unplugged?"
                                          : "the stream has ended, or stands still");
}

Result<Picture> OpenCvVideo::picture() {
  auto pixels = std::make_shared<cv::Mat>();
  try {
    if (capture_.retrieve(*pixels) && !pixels->empty() && pixels->type() == CV_8UC3) {
      turn(*pixels, quarters_);
      const Size size{pixels->cols, pixels->rows};
      return Picture{std::move(pixels), size};
    }
  } catch (const cv::Exception& problem) {
    return fail(ErrorCode::Io, told_source(source_), problem.what());
  }
  return fail(ErrorCode::Unavailable, told_source(source_), "its pictures cannot be read");
}

FileTiming OpenCvVideo::timing() const {
  double rate = capture_.get(cv::CAP_PROP_FPS);
  if (!(rate > 0.1 && rate < 1000.0)) rate = kUsualRate;
  FileTiming timing{from_seconds(1.0 / rate), std::nullopt};
  const double pictures = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  if (pictures >= 1.0 && pictures < 1e9) timing.length = from_seconds(pictures / rate);
  return timing;
}

tl::unexpected<Error> refused(const CameraSettings& settings) {
  const char* what = "no pictures can be read from the file; is it a video?";
  if (kind_of(settings.source) == SourceKind::Device)
    what = "the camera cannot be opened; does another program use it?";
  if (kind_of(settings.source) == SourceKind::Stream)
    what = "the stream cannot be opened; are address, name and password right?";
  return fail(ErrorCode::Unavailable, told_source(settings.source), what);
}

bool open_capture(cv::VideoCapture& capture, const CameraSettings& settings) {
  switch (kind_of(settings.source)) {
    case SourceKind::Device:
      return capture.open(settings.source, cv::CAP_V4L2);
    case SourceKind::Stream:
      return capture.open(settings.source, cv::CAP_FFMPEG,
                          {cv::CAP_PROP_OPEN_TIMEOUT_MSEC, kPatienceMs,
                           cv::CAP_PROP_READ_TIMEOUT_MSEC, kPatienceMs});
    case SourceKind::File:
      // Only this backend: the others are asked in vain, and libdc1394 leaks whenever it is asked.
      return capture.open(settings.source, cv::CAP_FFMPEG);
  }
  return false;
}

}  // namespace

std::string why_closed(const CameraSettings& settings) {
  if (kind_of(settings.source) == SourceKind::Stream) return "";
  const bool device = kind_of(settings.source) == SourceKind::Device;
  const int descriptor = open(settings.source.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (descriptor >= 0) {
    close(descriptor);
    return "";
  }
  const int reason = errno;
  if (reason == ENOENT && device)
    return "there is no such camera; is it plugged in?  `chorus camera list` shows those there are";
  if (reason == ENOENT) return "there is no such file";
  if (reason == EACCES && device)
    return "this user may not read the camera; add it to the group video";
  return std::strerror(reason);
}

Result<std::unique_ptr<Video>> open_video(const CameraSettings& settings) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  if (auto why = why_closed(settings); !why.empty())
    return fail(ErrorCode::NotFound, settings.source, std::move(why));
  cv::VideoCapture capture;
  try {
    if (!open_capture(capture, settings)) return refused(settings);
    if (kind_of(settings.source) == SourceKind::Device) ask_webcam(capture, settings);
  } catch (const cv::Exception&) {
    return refused(settings);
  }
  return std::make_unique<OpenCvVideo>(std::move(capture), settings.source);
}

}  // namespace chorus::camera
