#include "services/sensor/device/camera/camera_state.h"

#include <utility>

#include "common/base/log.h"

namespace chorus::camera {
namespace {

constexpr double kMillisecond = 1e3;

void smooth(double& value, Duration sample, bool first) {
  constexpr double kShare = 0.1;
  const double now = seconds(sample) * kMillisecond;
  value += first ? now - value : kShare * (now - value);
}

/// Logs a problem only when its reason changes, not on every attempt.
void told(const char* event, std::string& trouble, std::string why) {
  if (trouble != why) log::warn(event, {{"reason", why}});
  trouble = std::move(why);
}

}  // namespace

void CameraState::source_opened() {
  const std::lock_guard lock(mutex_);
  ++report_.connects;
}

void CameraState::source_failed(std::string why) {
  const std::lock_guard lock(mutex_);
  told("no pictures come", report_.source_trouble, std::move(why));
}

void CameraState::picture(Size size) {
  const std::lock_guard lock(mutex_);
  ++report_.pictures;
  if (!report_.source_trouble.empty()) log::info("pictures come again");
  report_.source_trouble.clear();
  report_.picture = size;
}

void CameraState::runner_ready(std::string name, std::string layout) {
  const std::lock_guard lock(mutex_);
  log::info("the runner is ready", {{"name", name}, {"layout", layout}});
  ++report_.starts;
  report_.runner = std::move(name);
  report_.layout = std::move(layout);
}

void CameraState::runner_failed(std::string why) {
  const std::lock_guard lock(mutex_);
  told("nobody looks at the pictures", report_.runner_trouble, std::move(why));
}

void CameraState::lens_fits(bool fits) {
  const std::lock_guard lock(mutex_);
  report_.lens_fits = fits;
}

void CameraState::answered(Size sent, Duration answer, Duration latency) {
  const std::lock_guard lock(mutex_);
  const bool first = report_.looked_at == 0;
  smooth(report_.answer_ms, answer, first);
  smooth(report_.latency_ms, latency, first);
  ++report_.looked_at;
  report_.sent = sent;
  report_.runner_trouble.clear();
}

void CameraState::outside(std::optional<bool> all) {
  constexpr int kEnough = 10;
  const std::lock_guard lock(mutex_);
  if (all == false) {
    outside_in_a_row_ = 0;
    report_.doubt.clear();
  }
  if (all != true || ++outside_in_a_row_ != kEnough) return;
  report_.doubt =
      "all landmarks lie outside the pictures: does the runner answer in pixels of the picture as "
      "it was sent (image.maxSide), with its width and height?";
  log::warn("what the runner finds looks wrong", {{"reason", report_.doubt}});
}

void CameraState::ended() {
  const std::lock_guard lock(mutex_);
  report_.over = true;
}

CameraReport CameraState::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

std::string CameraState::trouble() const {
  const CameraReport now = report();
  if (now.over) return "the video has ended; device.camera.loop true plays it again and again";
  std::string text = now.source_trouble;
  if (!text.empty() && !now.runner_trouble.empty()) text += "; ";
  return text + now.runner_trouble;
}

}  // namespace chorus::camera
