// Internal to common/record: reads the bytes of a recording piece by piece.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus::record {

/// A recording on disk or in memory.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Returns `count` bytes from `offset` on; fewer only at the end, or when the disk fails.
  [[nodiscard]] virtual std::string read(std::uint64_t offset, std::size_t count) const = 0;
};

/// Opens a file; the errors NotFound and Io name it.
[[nodiscard]] Result<std::unique_ptr<ByteSource>> open_bytes(const std::filesystem::path& path);
/// `bytes` must outlive the source.
[[nodiscard]] std::unique_ptr<ByteSource> bytes_in_memory(std::string_view bytes);

/// Reads forward in small steps without a system call for each step.
class ByteWalk {
 public:
  ByteWalk(const ByteSource& source, std::uint64_t offset) : source_(source), at_(offset) {}

  [[nodiscard]] std::uint64_t at() const { return at_; }
  [[nodiscard]] std::uint64_t left() const { return source_.size() - at_; }
  void skip(std::uint64_t count) { at_ += count; }
  /// The next bytes, without consuming them; fewer at the end.  Valid until peek() is called again.
  [[nodiscard]] std::string_view peek(std::size_t count);

 private:
  const ByteSource& source_;
  std::uint64_t at_;
  std::string ahead_;
  std::uint64_t ahead_at_ = 0;
};

}  // namespace chorus::record
