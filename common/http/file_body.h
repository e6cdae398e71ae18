// A file as the body of an answer: read piece by piece while it is sent, never whole in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "common/base/result.h"

namespace chorus::http {

/// Stays open while it is being read.  A file that grows is sent with the length it had at first.
class FileBody {
 public:
  /// NotFound for anything other than a regular file.
  [[nodiscard]] static Result<std::shared_ptr<const FileBody>> open(
      const std::filesystem::path& path);
  ~FileBody();
  FileBody(const FileBody&) = delete;
  FileBody& operator=(const FileBody&) = delete;

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Reads up to 256 KiB from `offset`; false when the file has become shorter.
  [[nodiscard]] bool read(std::uint64_t offset, std::string& piece) const;

 private:
  FileBody(int file, std::uint64_t size) : file_(file), size_(size) {}
  int file_;
  std::uint64_t size_;
};

}  // namespace chorus::http
