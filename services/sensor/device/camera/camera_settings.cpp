#include "services/sensor/device/camera/camera_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/sensor/impossible_lens.h"

namespace chorus::camera {
namespace {

constexpr int kMaxSide = 16384;
constexpr double kMaxPixels = 1e5;

void read_distortion(ConfigReader& section, Intrinsics& out) {
  std::vector<double> distortion;
  section.read("distortion", distortion);
  std::size_t model = 0;
  section.read_choice("model", model, {"brown", "fisheye"});
  if (model == 1) out.model = LensModel::Fisheye;
  if (distortion.empty()) return;
  if (distortion.size() != out.distortion.size())
    return section.complain(
        "distortion",
        "must be k1, k2, p1, p2, k3, as OpenCV has them; of a fisheye k1, k2, k3, "
        "k4 and 0");
  std::copy(distortion.begin(), distortion.end(), out.distortion.begin());
}

void read_intrinsics(ConfigReader section, CameraSettings& out) {
  constexpr double kPercent = 0.01;
  Intrinsics camera;
  double sigma_percent = 0.0;
  const std::array<const char*, 6> needed{"width", "height", "fx", "fy", "cx", "cy"};
  if (std::none_of(needed.begin(), needed.end(), [&](const char* k) { return section.has(k); })) {
    section.complain("width",
                     "is missing, like the rest of the lens: width, height, fx, fy, cx and cy are "
                     "stated here themselves, as $(cat lens.json) writes them");
  } else {
    for (const char* key : needed) {
      if (!section.has(key)) section.complain(key, "is missing; a lens is stated as a whole");
    }
  }
  section.read("width", camera.width, 16, kMaxSide);
  section.read("height", camera.height, 16, kMaxSide);
  section.read("fx", camera.fx, 1.0, kMaxPixels);
  section.read("fy", camera.fy, 1.0, kMaxPixels);
  section.read("cx", camera.cx, -kMaxPixels, kMaxPixels);
  section.read("cy", camera.cy, -kMaxPixels, kMaxPixels);
  read_distortion(section, camera);
  if (const auto objection = objection_to(camera))
    section.complain(objection->key, objection->text);
  section.read("focal_sigma_percent", sigma_percent, 0.0, 50.0);
  out.intrinsics = camera;
  out.focal_sigma = sigma_percent * kPercent;
}

void read_lens(ConfigReader& section, CameraSettings& out) {
  section.read_deg("fov_deg", out.fov, 5.0, 150.0);
  section.read_deg("fov_sigma_deg", out.fov_sigma, 0.0, 30.0);
  if (section.has("intrinsics")) read_intrinsics(section.child("intrinsics"), out);
}

/// Reads height and pitch as a floor plane.  If the camera looks down by `pitch`, "up" is tilted
/// back towards the camera.
void read_place(ConfigReader& section, CameraSettings& out) {
  double height = 0.0;
  double pitch = 0.0;
  section.read("height_m", height, 0.0, 100.0);
  section.read_deg("pitch_deg", pitch, -80.0, 80.0);
  if (height > 0.0)
    out.floor = FloorPlane{Eigen::Vector3d(0.0, std::cos(pitch), -std::sin(pitch)), height};
}

}  // namespace

SourceKind kind_of(const std::string& source) {
  if (source.find("://") != std::string::npos) return SourceKind::Stream;
  return source.starts_with("/dev/") ? SourceKind::Device : SourceKind::File;
}

std::string meant_source(std::string source) {
  const bool number =
      !source.empty() && source.find_first_not_of("0123456789") == std::string::npos;
  return number ? "/dev/video" + source : source;
}

std::string told_source(const std::string& source) {
  const std::size_t scheme = source.find("://");
  if (scheme == std::string::npos) return source;
  const std::size_t begin = scheme + 3;
  const std::size_t slash = std::min(source.find('/', begin), source.size());
  const std::size_t at = source.rfind('@', slash);
  if (at == std::string::npos || at < begin) return source;
  return source.substr(0, begin) + source.substr(at + 1);
}

CameraSettings read_camera_settings(ConfigReader& section) {
  CameraSettings settings;
  section.read("source", settings.source);
  settings.source = meant_source(std::move(settings.source));
  if (settings.source.empty())
    section.complain("source", "is empty; say /dev/video0, an rtsp:// address or a video file");
  section.read("label", settings.label);
  section.read("width", settings.width, 0, kMaxSide);
  section.read("height", settings.height, 0, kMaxSide);
  section.read("rate_hz", settings.rate_hz, 0.0, 1000.0);
  section.read("loop", settings.loop);
  section.read_ms("latency_ms", settings.latency, Duration{0}, std::chrono::seconds(5));
  section.read("max_rate_hz", settings.max_rate_hz, 0.1, 1000.0);
  section.read("runner", settings.runner);
  section.read("model", settings.model);
  section.read("depth_from_size", settings.depth_from_size);
  read_lens(section, settings);
  read_place(section, settings);
  return settings;
}

}  // namespace chorus::camera
