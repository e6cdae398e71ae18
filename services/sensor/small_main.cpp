// chorus-sensor as every sensor host has it: without the device camera, whose OpenCV brings more
// than a hundred packages. Where the whole program is installed (the package chorus-camera), it is
// run instead.
#include "common/service/hosted_program.h"
#include "common/service/whole_program.h"
#include "services/sensor/device/camera/camera.h"
#include "services/sensor/sensor_host.h"

namespace chorus::camera {

/// In place of the one in the library, which is then not linked, nor what it needs.
Result<std::unique_ptr<FrameSource>> make_camera(ConfigReader& /*section*/,
                                                 const sensor_service::DeviceContext& /*context*/) {
  return fail(ErrorCode::NotFound, "device.kind",
              "cameras come with a package of their own: apt install chorus-camera");
}

}  // namespace chorus::camera

int main(int argc, char** argv) {
  using namespace chorus::sensor_service;
  chorus::service::become_whole_program("chorus-camera-sensor", argv);
  return chorus::service::run_service<SensorSettings, SensorHost>(
      about_sensor(), &read_sensor_settings, argc, argv);
}
