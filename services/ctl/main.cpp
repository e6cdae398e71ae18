// chorus: the command line.
#include "services/ctl/command.h"

int main(int argc, char** argv) { return chorus::ctl::run_command_line(argc, argv); }
