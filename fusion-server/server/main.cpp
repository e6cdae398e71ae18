// chorus-fusion: many sensors, one tracker.
#include "fusion-server/server/fusion_program.h"

int main(int argc, char** argv) {
  using chorus::server::FusionProgram;
  FusionProgram program;
  return chorus::service::run_program(FusionProgram::about(), program, argc, argv);
}
