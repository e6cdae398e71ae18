#include "services/sensor/lazy_image.h"

#include <exception>
#include <utility>

namespace chorus::sensor_service {

namespace {

Result<CameraImage> encoded(const std::function<Result<CameraImage>()>& encode) {
  try {
    return encode();
  } catch (const std::exception& failure) {
    return fail(ErrorCode::Internal, "image", failure.what());
  } catch (...) {
    return fail(ErrorCode::Internal, "image", "the encoder threw what is no exception");
  }
}

}  // namespace

LazyImage::LazyImage(std::function<Result<CameraImage>()> encode) : encode_(std::move(encode)) {}

const Result<CameraImage>& LazyImage::get() const {
  std::call_once(once_, [this] {
    image_ = encoded(encode_);
    encode_ = nullptr;
  });
  return image_;
}

}  // namespace chorus::sensor_service
