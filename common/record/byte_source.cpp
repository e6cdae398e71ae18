#include "common/record/byte_source.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace chorus::record {
namespace {

// Number of bytes that are read ahead: enough for the head of a record and a message index; the
// content of records is skipped.
constexpr std::size_t kAhead = 4096;

class FileBytes final : public ByteSource {
 public:
  FileBytes(int file, std::uint64_t size) : file_(file), size_(size) {}
  ~FileBytes() override { ::close(file_); }
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] std::string read(std::uint64_t offset, std::size_t count) const override {
    std::string bytes(std::min<std::uint64_t>(count, size_ - std::min(offset, size_)), '\0');
    std::size_t got = 0;
    while (got < bytes.size()) {
      const ssize_t more =
          ::pread(file_, bytes.data() + got, bytes.size() - got, static_cast<off_t>(offset + got));
      if (more < 0 && errno == EINTR) continue;
      if (more <= 0) break;
      got += static_cast<std::size_t>(more);
    }
    bytes.resize(got);
    return bytes;
  }

 private:
  int file_;
  std::uint64_t size_;
};

class MemoryBytes final : public ByteSource {
 public:
  explicit MemoryBytes(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  [[nodiscard]] std::string read(std::uint64_t offset, std::size_t count) const override {
    if (offset >= bytes_.size()) return {};
    return std::string(bytes_.substr(offset, count));
  }

 private:
  std::string_view bytes_;
};

}  // namespace

Result<std::unique_ptr<ByteSource>> open_bytes(const std::filesystem::path& path) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct ::stat about {};
  const bool stated = file >= 0 && ::fstat(file, &about) == 0;
  if (stated && S_ISREG(about.st_mode)) {
    return std::unique_ptr<ByteSource>(
        std::make_unique<FileBytes>(file, static_cast<std::uint64_t>(about.st_size)));
  }
  const int error = stated ? EINVAL : errno;
  if (file >= 0) ::close(file);
  return fail(error == ENOENT ? ErrorCode::NotFound : ErrorCode::Io, path.string(),
              std::string("cannot read the recording: ") +
                  (stated ? "it is no regular file" : std::strerror(error)));
}

std::unique_ptr<ByteSource> bytes_in_memory(std::string_view bytes) {
  return std::make_unique<MemoryBytes>(bytes);
}

std::string_view ByteWalk::peek(std::size_t count) {
  const bool there = at_ >= ahead_at_ && at_ + count <= ahead_at_ + ahead_.size();
  if (!there) {
    ahead_ = source_.read(at_, std::max(count, kAhead));
    ahead_at_ = at_;
  }
  return std::string_view(ahead_).substr(static_cast<std::size_t>(at_ - ahead_at_), count);
}

}  // namespace chorus::record
