#include "services/ctl/line/photo_files.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace chorus::ctl {

namespace fs = std::filesystem;

bool is_photo(const fs::path& file) {
  constexpr std::array kEndings{".jpg",  ".jpeg", ".png",  ".bmp", ".tif",
                                ".tiff", ".webp", ".heic", ".heif"};
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// A picture that `chorus scan` drew.
bool is_annotated(const fs::path& file) { return file.stem().extension() == ".annotated"; }

Result<std::vector<std::string>> photo_files(const std::vector<std::string>& sources) {
  std::vector<std::string> files;
  for (const std::string& source : sources) {
    std::error_code failed;
    if (!fs::is_directory(source, failed)) {
      files.push_back(source);
      continue;
    }
    const std::size_t before = files.size();
    for (const auto& entry : fs::directory_iterator(source, failed)) {
      if (is_photo(entry.path()) && !is_annotated(entry.path()))
        files.push_back(entry.path().string());
    }
    if (files.size() == before)
      return fail(ErrorCode::NotFound, source, "holds no photos (.jpg, .png, .bmp, .tif, .webp)");
    std::sort(files.begin() + static_cast<std::ptrdiff_t>(before), files.end());
  }
  return files;
}

}  // namespace chorus::ctl
