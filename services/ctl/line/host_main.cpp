// chorus as installed on every host: small, without the commands for recordings.  If the whole
// program is installed as well (package chorus-tools: ../libexec/chorus/chorus next to our folder),
// this one runs that program instead.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <string>

#include "common/service/whole_program.h"
#include "services/ctl/line/command.h"

namespace {

bool is_elsewhere(const std::string& word) {
  const auto& names = chorus::ctl::kRecordingCommandNames;
  return std::find(names.begin(), names.end(), word) != names.end();
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGUSR1, SIGUSR2}) std::signal(signal, SIG_IGN);  // As in main.cpp.
  chorus::service::become_whole_program("../libexec/chorus/chorus", argv);
  if (argc > 1 && is_elsewhere(argv[1])) {
    std::fprintf(stderr,
                 "chorus: \"%s\" works on recordings or pictures and comes with another package: "
                 "apt install "
                 "chorus-tools\n",
                 argv[1]);
    return chorus::ctl::kExitUsage;
  }
  return chorus::ctl::run_command_line(chorus::ctl::host_commands(), argc, argv);
}
