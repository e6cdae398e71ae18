// chorus-sensor as installed on every sensor host: without the device `camera`, because its OpenCV
// needs more than a hundred packages.  If the whole program is installed as well (package
// chorus-camera), this one runs that program instead.
#include "common/service/hosted_program.h"
#include "common/service/whole_program.h"
#include "services/sensor/device/camera/camera.h"
#include "services/sensor/device/glove/glove.h"
#include "services/sensor/device/positioner/picture_eye.h"
#include "services/sensor/device/scan/photo_scan.h"
#include "services/sensor/sensor_host.h"

namespace chorus::camera {

/// Replaces the function of the camera library, so that neither that library nor its dependencies
/// are linked.
Result<std::unique_ptr<FrameSource>> make_camera(ConfigReader& /*section*/,
                                                 const sensor_service::DeviceContext& /*context*/) {
  return fail(ErrorCode::NotFound, "device.kind",
              "cameras come with a package of their own: apt install chorus-camera");
}

Result<std::unique_ptr<FrameSource>> make_watched_camera(
    ConfigReader& section, const sensor_service::DeviceContext& context, PictureWatch /*watch*/) {
  return make_camera(section, context);
}

}  // namespace chorus::camera

namespace chorus::glove {

/// The same for gloves before a camera.
Result<std::unique_ptr<FrameSource>> make_glove(ConfigReader& /*section*/,
                                                const sensor_service::DeviceContext& /*context*/) {
  return fail(ErrorCode::NotFound, "device.kind",
              "cameras come with a package of their own: apt install chorus-camera");
}

}  // namespace chorus::glove

namespace chorus::positioner {

/// The same for what looks at pictures; without cameras there are none.
std::unique_ptr<PictureEye> make_eye(EyeSettings /*settings*/) { return nullptr; }

}  // namespace chorus::positioner

namespace chorus::scan {

/// The same for scans of photos.
ScanPhoto photo_scan() { return {}; }

}  // namespace chorus::scan

int main(int argc, char** argv) {
  using namespace chorus::sensor_service;
  chorus::service::become_whole_program("chorus-camera-sensor", argv);
  return chorus::service::run_service<SensorSettings, SensorHost>(
      about_sensor(), &read_sensor_settings, argc, argv);
}
