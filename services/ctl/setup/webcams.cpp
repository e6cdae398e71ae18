#include "services/ctl/setup/webcams.h"

#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "services/ctl/line/console.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kMost = 64;  // at most this many formats, sizes and rates, each

class Device {
 public:
  explicit Device(const std::string& path)
      : descriptor_(open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {}
  ~Device() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  [[nodiscard]] bool opened() const { return descriptor_ >= 0; }
  template <class Question>
  [[nodiscard]] bool ask(unsigned long what, Question& question) const {
    int failed = 0;
    do {
      failed = ioctl(descriptor_, what, &question);
    } while (failed < 0 && errno == EINTR);
    return failed >= 0;
  }

 private:
  int descriptor_;
};

template <std::size_t N>
std::string text_of(const unsigned char (&bytes)[N]) {
  const auto* begin = reinterpret_cast<const char*>(bytes);
  return {begin, strnlen(begin, N)};
}

std::string letters(std::uint32_t code) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += static_cast<char>((code >> (8 * i)) & 0x7f);
  return text;
}

/// The highest rate for this size; 0 when the driver does not report it.
double rate_of(const Device& device, std::uint32_t format, std::uint32_t width,
               std::uint32_t height) {
  double best = 0.0;
  for (std::uint32_t i = 0; i < kMost; ++i) {
    v4l2_frmivalenum interval{};
    interval.index = i;
    interval.pixel_format = format;
    interval.width = width;
    interval.height = height;
    if (!device.ask(VIDIOC_ENUM_FRAMEINTERVALS, interval)) break;
    const bool steps = interval.type != V4L2_FRMIVAL_TYPE_DISCRETE;
    const v4l2_fract step = steps ? interval.stepwise.min : interval.discrete;
    if (step.numerator > 0)
      best = std::max(best, static_cast<double>(step.denominator) / step.numerator);
    if (steps) break;
  }
  return best;
}

void add_modes(const Device& device, std::uint32_t format, std::vector<WebcamMode>& out) {
  for (std::uint32_t i = 0; i < kMost; ++i) {
    v4l2_frmsizeenum size{};
    size.index = i;
    size.pixel_format = format;
    if (!device.ask(VIDIOC_ENUM_FRAMESIZES, size)) return;
    const bool steps = size.type != V4L2_FRMSIZE_TYPE_DISCRETE;
    const std::uint32_t width = steps ? size.stepwise.max_width : size.discrete.width;
    const std::uint32_t height = steps ? size.stepwise.max_height : size.discrete.height;
    out.push_back({letters(format), static_cast<int>(width), static_cast<int>(height),
                   rate_of(device, format, width, height)});
    if (steps) return;
  }
}

/// None when the device is not a camera but, for example, an encoder, or a webcam's second device,
/// which carries metadata.
std::optional<Webcam> webcam_at(const std::string& path) {
  const Device device(path);
  if (!device.opened()) {
    const char* const why = errno == EACCES ? "this user may not open it; add it to the group video"
                                            : std::strerror(errno);
    return Webcam{path, "", "", {}, why};
  }
  v4l2_capability about{};
  if (!device.ask(VIDIOC_QUERYCAP, about)) return std::nullopt;
  const std::uint32_t abilities =
      (about.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? about.device_caps : about.capabilities;
  if ((abilities & V4L2_CAP_VIDEO_CAPTURE) == 0) return std::nullopt;
  Webcam camera{path, text_of(about.card), text_of(about.bus_info)};
  for (std::uint32_t i = 0; i < kMost; ++i) {
    v4l2_fmtdesc format{};
    format.index = i;
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (!device.ask(VIDIOC_ENUM_FMT, format)) break;
    add_modes(device, format.pixelformat, camera.modes);
  }
  if (camera.modes.empty()) camera.problem = "its driver names no format";
  return camera;
}

std::optional<int> number_of(const fs::path& path) {
  const std::string name = path.filename().string();
  constexpr std::string_view kVideo = "video";
  int number = 0;
  if (!name.starts_with(kVideo)) return std::nullopt;
  const auto read = std::from_chars(name.data() + kVideo.size(), name.data() + name.size(), number);
  const bool whole = read.ec == std::errc() && read.ptr == name.data() + name.size();
  return whole ? std::optional(number) : std::nullopt;
}

std::string shown_mode(const WebcamMode& mode) {
  const std::string rate = mode.rate_hz > 0.0 ? shown(mode.rate_hz, 0) : "?";
  return fmt::format("{} x {}, {} Hz", mode.width, mode.height, rate);
}

}  // namespace

std::vector<Webcam> webcams(const fs::path& folder) {
  std::map<int, std::string> paths;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (const auto number = number_of(entry.path())) paths[*number] = entry.path().string();
  }
  std::vector<Webcam> found;
  for (const auto& [number, path] : paths) {
    if (auto camera = webcam_at(path)) found.push_back(std::move(*camera));
  }
  return found;
}

std::string webcam_report(const std::vector<Webcam>& cameras) {
  if (cameras.empty()) {
    return "no webcams here: this host has no video device that takes pictures (/dev/video0).\n"
           "Plug one in; in a container or virtual machine, hand the device on.  A stream or a\n"
           "video file works as well: chorus-sensor --camera rtsp://..., --camera walk.mp4\n";
  }
  std::vector<std::vector<std::string>> rows{{"source", "name", "format", "sizes", "plugged in"}};
  for (const Webcam& camera : cameras) {
    if (!camera.problem.empty()) rows.push_back({camera.path, camera.name, camera.problem, "", ""});
    std::string before;
    for (const WebcamMode& mode : camera.modes) {
      const bool first = before.empty();
      rows.push_back({first ? camera.path : "", first ? camera.name : "",
                      mode.format == before ? "" : mode.format, shown_mode(mode),
                      first ? camera.bus : ""});
      before = mode.format;
    }
  }
  return table(std::move(rows)) + "\nThen: chorus-sensor --camera " + cameras.front().path + "\n";
}

}  // namespace chorus::ctl
