// The program chorus-fusion: fuses the bodies that many sensors see into those of one tracker.
#include "common/base/memory.h"
#include "common/service/hosted_program.h"
#include "fusion-server/server/fusion_server.h"

int main(int argc, char** argv) {
  using namespace chorus::server;
  chorus::return_large_blocks();
  return chorus::service::run_service<FusionSettings, FusionServer>(
      about_fusion(), &read_fusion_settings, argc, argv);
}
