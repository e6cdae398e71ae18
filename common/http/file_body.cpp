#include "common/http/file_body.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace chorus::http {

namespace {
constexpr std::uint64_t kPiece = 256u << 10;
}

Result<std::shared_ptr<const FileBody>> FileBody::open(const std::filesystem::path& path) {
  // Non-blocking: opening a FIFO must not wait for its writer.
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
  struct stat status {};
  const bool regular = file >= 0 && ::fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  if (regular) {
    return std::shared_ptr<const FileBody>(
        new FileBody(file, static_cast<std::uint64_t>(status.st_size)));
  }
  const char* reason = file < 0 ? std::strerror(errno) : "it is no regular file";
  auto failed = fail(ErrorCode::NotFound, path.filename().string(), reason);
  if (file >= 0) ::close(file);
  return failed;
}

FileBody::~FileBody() { ::close(file_); }

bool FileBody::read(std::uint64_t offset, std::string& piece) const {
  const std::uint64_t wanted = std::min(kPiece, size_ - std::min(offset, size_));
  piece.resize(static_cast<std::size_t>(wanted));
  std::size_t got = 0;
  while (got < piece.size()) {
    const ssize_t count =
        ::pread(file_, piece.data() + got, piece.size() - got, static_cast<off_t>(offset + got));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    got += static_cast<std::size_t>(count);
  }
  return true;
}

}  // namespace chorus::http
