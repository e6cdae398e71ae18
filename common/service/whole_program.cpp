#include "common/service/whole_program.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>

namespace chorus::service {

void become_whole_program(const std::string& path, char** arguments) {
  std::error_code failed;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", failed);
  if (!failed) ::execv((self.parent_path() / path).c_str(), arguments);
}

}  // namespace chorus::service
