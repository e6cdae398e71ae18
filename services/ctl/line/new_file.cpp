#include "services/ctl/line/new_file.h"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string_view>

namespace chorus::ctl {
namespace {

mode_t mode_for(Readers readers) {
  switch (readers) {
    case Readers::Services:
      return 0640;
    case Readers::Owner:
      return 0600;
    case Readers::Everybody:
      return 0644;
  }
  return 0600;
}

Result<void> cannot(const std::string& file, int why, const std::string& option = {}) {
  return fail(ErrorCode::Io, file,
              std::string("cannot be written: ") + std::strerror(why) + option);
}

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

/// Changes the file's group to that of the services, if possible.
bool hand_over(int file) {
  const group* const services = ::getgrnam("chorus");
  return services == nullptr || ::geteuid() != 0 || ::fchown(file, 0, services->gr_gid) == 0;
}

/// The umask restricts the mode of open() and mkdir(): with 077 the services could not read their
/// configuration, and nobody could read ca.crt.  A file system without modes does not count as a
/// failure.
bool give_mode(int file, mode_t mode) {
  return ::fchmod(file, mode) == 0 || errno == EPERM || errno == ENOTSUP;
}

}  // namespace

Result<void> write_file(const std::string& file, const std::string& text, Readers readers,
                        Overwriting overwriting) {
  if (file == "-") {
    std::cout << text;
    return {};
  }
  // Writes a new file next to the old one, so that readers always get either the old or the new one
  // in full.
  const std::string fresh = overwriting == Overwriting::Yes ? file + ".new" : file;
  if (overwriting == Overwriting::Yes) ::unlink(fresh.c_str());
  const int made =
      ::open(fresh.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode_for(readers));
  if (made < 0 && errno == EEXIST) {
    return fail(ErrorCode::InvalidArgument, file,
                "exists and is not overwritten: edit it, move it away, or give --out FILE");
  }
  if (made < 0 && errno == ENOENT)
    return cannot(file, ENOENT, ": its folder is not there; make it, or give --out FILE");
  if (made < 0) return cannot(file, errno, " (as root, or with --out FILE)");
  const bool written = (readers != Readers::Services || hand_over(made)) &&
                       give_mode(made, mode_for(readers)) && write_all(made, text);
  int why = errno;  // close() may change it
  ::close(made);
  if (written && (fresh == file || ::rename(fresh.c_str(), file.c_str()) == 0)) return {};
  if (written) why = errno;
  ::unlink(fresh.c_str());
  return cannot(file, why);
}

Result<void> make_folder(const std::string& named, Readers readers) {
  std::error_code failed;
  if (std::filesystem::is_directory(named, failed)) return {};
  // The parent of "x/tls/" would be "x/tls", the folder itself, so a trailing slash is removed.
  std::filesystem::path path(named);
  if (!path.has_filename()) path = path.parent_path();
  const std::string folder = path.string();
  const std::filesystem::path above = path.parent_path();
  if (!above.empty()) std::filesystem::create_directories(above, failed);
  const bool shared = readers == Readers::Services;
  constexpr mode_t kShared = 0751;  // everybody may read the ca.crt in it, by its name
  const mode_t mode = shared ? kShared : 0700;
  if (::mkdir(folder.c_str(), mode) != 0)
    return cannot(folder, errno, " (as root, or with --out FOLDER)");
  const int made = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool handed = made >= 0 && (!shared || hand_over(made)) && give_mode(made, mode);
  const int why = errno;  // close() may change it
  if (made >= 0) ::close(made);
  return handed ? Result<void>{} : cannot(folder, why);
}

}  // namespace chorus::ctl
