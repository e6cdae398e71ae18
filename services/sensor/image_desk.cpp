#include "services/sensor/image_desk.h"

#include <utility>

namespace chorus::sensor_service {

namespace {

/// After a request, images are encoded as fast as possible for this long.
constexpr std::chrono::seconds kDemandLasts{2};
/// Otherwise one capture is encoded in this time.
constexpr std::chrono::seconds kIdlePace{1};

}  // namespace

void ImageDesk::allow(bool on) {
  const std::lock_guard lock(mutex_);
  on_ = on;
  if (!on) pictured_ = nullptr;
  changed_.notify_all();
}

bool ImageDesk::allowed() const {
  const std::lock_guard lock(mutex_);
  return on_;
}

void ImageDesk::offer(LatestCapturePtr latest) {
  const std::lock_guard lock(mutex_);
  offered_ = std::move(latest);
  if (on_) changed_.notify_all();
}

Result<LatestCapturePtr> ImageDesk::ask() {
  const std::lock_guard lock(mutex_);
  if (!on_) {
    return fail(ErrorCode::NotFound, "images", "images are switched off; set images: true");
  }
  asked_ = steady_now_();
  changed_.notify_all();
  if (!pictured_) {
    return fail(ErrorCode::Unavailable, "images", "the first image is still being encoded");
  }
  return pictured_;
}

/// True when images should be encoded now.  Call it with the mutex held.
bool ImageDesk::due() const {
  if (!on_ || offered_ == pictured_ || !offered_) return false;
  const auto now = steady_now_();
  return !pictured_ || now - asked_ < kDemandLasts || now - encoded_ >= kIdlePace;
}

bool ImageDesk::encode_next(const std::stop_token& stop) {
  LatestCapturePtr latest;
  {
    std::unique_lock lock(mutex_);
    if (!changed_.wait(lock, stop, [this] { return due(); })) return false;
    latest = offered_;
  }
  try {
    if (latest->color) (void)latest->color->get();
    if (latest->depth) (void)latest->depth->get();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    // So that this capture does not fail again and again.
    if (offered_ == latest) offered_ = nullptr;
    throw;
  }
  const std::lock_guard lock(mutex_);
  encoded_ = steady_now_();
  if (on_) pictured_ = std::move(latest);
  return true;
}

}  // namespace chorus::sensor_service
