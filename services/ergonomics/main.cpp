// chorus-ergonomics: posture scores of the people of a tracker.
#include "common/service/hosted_program.h"
#include "services/ergonomics/ergonomics_host.h"

int main(int argc, char** argv) {
  using namespace chorus::ergonomics_service;
  return chorus::service::run_service<ErgonomicsSettings, ErgonomicsHost>(
      about_ergonomics(), &read_ergonomics_settings, argc, argv);
}
