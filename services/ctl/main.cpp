// chorus: the command line program.
#include "services/ctl/command.h"

int main(int argc, char** argv) {
  using namespace chorus::ctl;
  return run_command_line(all_commands(), argc, argv);
}
