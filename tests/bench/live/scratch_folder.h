// A temporary folder that is removed together with its owner.
#pragma once

#include <filesystem>

#include "common/base/result.h"

namespace chorus::bench {

class ScratchFolder {
 public:
  [[nodiscard]] static Result<ScratchFolder> make();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;  ///< Empty: moved to another owner.
};

}  // namespace chorus::bench
