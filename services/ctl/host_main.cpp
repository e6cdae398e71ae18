// chorus as every host has it: small, without what works on recordings.  Where the whole program is
// installed (the package chorus-tools: ../libexec/chorus/chorus beside our folder), it is run
// instead.
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <system_error>

#include "services/ctl/command.h"

namespace {

std::filesystem::path whole_program() {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  return self.parent_path().parent_path() / "libexec/chorus/chorus";
}

bool is_elsewhere(const std::string& word) {
  const auto& names = chorus::ctl::kRecordingCommandNames;
  return std::find(names.begin(), names.end(), word) != names.end();
}

}  // namespace

int main(int argc, char** argv) {
  execv(whole_program().c_str(), argv);  // Returns only when it is not there.
  if (argc > 1 && is_elsewhere(argv[1])) {
    std::fprintf(stderr,
                 "chorus: \"%s\" works on recordings and comes with another package: apt install "
                 "chorus-tools\n",
                 argv[1]);
    return chorus::ctl::kExitUsage;
  }
  return chorus::ctl::run_command_line(chorus::ctl::host_commands(), argc, argv);
}
