#include "common/base/shipped_folder.h"

#include <filesystem>
#include <system_error>

namespace chorus {

Result<std::string> shipped_folder(std::string_view name, std::string_view sign) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path here = fs::read_symlink("/proc/self/exe", failed).parent_path();
  for (const fs::path& place :
       {here / "../share/chorus", here / "../../../services", fs::path("services")}) {
    const fs::path folder = (place / name).lexically_normal();
    if (fs::exists(folder / sign, failed)) return folder.string();
  }
  return fail(ErrorCode::NotFound, std::string(name), "is not installed");
}

}  // namespace chorus
