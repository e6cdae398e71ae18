#include "services/ctl/line/command.h"

namespace chorus::ctl {

std::vector<Command> all_commands() {
  std::vector<Command> all(recording_commands().begin(), recording_commands().end());
  all.insert(all.begin() + 1, host_commands().begin(), host_commands().end());  // after `import`
  return all;
}

}  // namespace chorus::ctl
