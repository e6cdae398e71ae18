// chorus-evaluation: judges a tracker by worn inertial sensors.
#include "common/service/hosted_program.h"
#include "services/evaluation/evaluation_host.h"

int main(int argc, char** argv) {
  using namespace chorus::evaluation_service;
  return chorus::service::run_service<EvaluationSettings, EvaluationHost>(
      about_evaluation(), &read_evaluation_settings, argc, argv);
}
