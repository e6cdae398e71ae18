// A file as the body of an answer: it is read piece by piece while it is sent.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "common/base/result.h"

namespace chorus::http {

/// The file stays open as long as the object exists.  A file that grows meanwhile is sent with the
/// length that it had at first.
class FileBody {
 public:
  /// NotFound if it cannot be opened, or is not a regular file (a symbolic link is not).
  [[nodiscard]] static Result<std::shared_ptr<const FileBody>> open(
      const std::filesystem::path& path);
  ~FileBody();
  FileBody(const FileBody&) = delete;
  FileBody& operator=(const FileBody&) = delete;

  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Replaces `piece` with up to 256 KiB from `offset`; false when the file has become shorter or
  /// cannot be read.
  [[nodiscard]] bool read(std::uint64_t offset, std::string& piece) const;

 private:
  FileBody(int file, std::uint64_t size) : file_(file), size_(size) {}
  int file_;
  std::uint64_t size_;
};

}  // namespace chorus::http
