#include "services/ctl/new_file.h"

#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iostream>

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

Result<void> cannot(const std::string& file, const std::string& option = {}) {
  return fail(ErrorCode::Io, file,
              std::string("cannot be written: ") + std::strerror(errno) + option);
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
  if (made < 0) return cannot(file, " (as root, or with --out FILE)");
  const bool handed =
      (readers != Readers::Services || hand_over(made)) && give_mode(made, mode_for(readers));
  const bool written = ::write(made, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  ::close(made);
  if (handed && written && (fresh == file || ::rename(fresh.c_str(), file.c_str()) == 0)) return {};
  const auto failure = cannot(file);
  ::unlink(fresh.c_str());
  return failure;
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
  if (::mkdir(folder.c_str(), mode) != 0) return cannot(folder, " (as root, or with --out FOLDER)");
  const int made = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool handed = made >= 0 && (!shared || hand_over(made)) && give_mode(made, mode);
  if (made >= 0) ::close(made);
  return handed ? Result<void>{} : cannot(folder);
}

}  // namespace chorus::ctl
