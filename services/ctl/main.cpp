// chorus: the command line.
#include "services/ctl/command.h"

int main(int argc, char** argv) {
  using namespace chorus::ctl;
  return run_command_line(all_commands(), argc, argv);
}
