// chorus: the command line program.
#include <csignal>

#include "services/ctl/line/command.h"

int main(int argc, char** argv) {
  using namespace chorus::ctl;
  // They mean nothing here, and must not end a recording that runs for an hour.
  for (const int signal : {SIGUSR1, SIGUSR2}) std::signal(signal, SIG_IGN);
  return run_command_line(all_commands(), argc, argv);
}
