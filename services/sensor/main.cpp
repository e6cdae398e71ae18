// chorus-sensor: one device as REST resources.
#include "services/sensor/sensor_program.h"

int main(int argc, char** argv) {
  using chorus::sensor_service::SensorProgram;
  SensorProgram program;
  return chorus::service::run_program(SensorProgram::about(), program, argc, argv);
}
