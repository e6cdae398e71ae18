// chorus-sensor: serves one device as REST resources.
#include "common/service/hosted_program.h"
#include "services/sensor/sensor_host.h"

int main(int argc, char** argv) {
  using namespace chorus::sensor_service;
  return chorus::service::run_service<SensorSettings, SensorHost>(
      about_sensor(), &read_sensor_settings, argc, argv);
}
