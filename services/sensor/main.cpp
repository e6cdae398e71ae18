// chorus-sensor: one device as REST resources.  The wiring is in sensor_host.h.
#include "services/sensor/sensor_host.h"

int main(int argc, char** argv) {
  using namespace chorus::sensor_service;
  const CommandLine command = read_command_line(argc, argv);
  return command.exit ? *command.exit : run_sensor(command);
}
