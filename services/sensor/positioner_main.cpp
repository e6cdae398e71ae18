// chorus-positioner: a chorus-sensor whose device is `positioner`, unless the command line or the
// configuration says otherwise.
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "common/service/hosted_program.h"
#include "services/sensor/sensor_host.h"

int main(int argc, char** argv) {
  using namespace chorus::sensor_service;
  std::vector<char*> arguments(argv, argv + argc);
  std::array<std::string, 2> chosen{"--device", "positioner"};
  bool stated = false;
  for (const char* argument : arguments) stated = stated || argument == chosen[0];
  if (!stated)
    for (std::string& word : chosen) arguments.push_back(word.data());
  return chorus::service::run_service<SensorSettings, SensorHost>(
      about_positioner(), &read_sensor_settings, static_cast<int>(arguments.size()),
      arguments.data());
}
