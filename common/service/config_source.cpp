#include "common/service/config_source.h"

#include "common/base/file.h"

namespace chorus::service {
namespace {

/// What to do about a file that is not there, or that another user may read.
std::string advice_on(ErrorCode code) {
  if (code == ErrorCode::NotFound) return "; `chorus init` writes one (--out FILE)";
  return code == ErrorCode::Io ? "; is it a file that this user may read? The services' user is "
                                 "chorus (sudo runuser -u chorus -- COMMAND)"
                               : "";
}

Result<std::string> text_of(const std::string& path) {
  constexpr std::uintmax_t kMaxBytes = 16u << 20;
  if (path.empty()) return std::string("{}");
  auto text = read_file_or_pipe(path, kMaxBytes);
  if (text) return text;
  return fail(ErrorCode::Io, path,
              "the configuration file cannot be read: " + text.error().message +
                  advice_on(text.error().code));
}

/// What messages call the source: the file, the options of the command line, or both.
std::string name_of(const ConfigSource& source) {
  const bool options = !source.assignments.empty();
  if (source.path.empty()) return options ? "options" : "defaults";
  return options ? source.path + " with the options" : source.path;
}

}  // namespace

Result<ConfigReader> read_config(const ConfigSource& source) {
  const auto text = text_of(source.path);
  if (!text) return pass(text);
  auto root = ConfigReader::parse(*text, name_of(source));
  if (!root) return fail(root.error().code, source.path, root.error().message);
  for (const std::string& assignment : source.assignments) {
    if (auto ok = root->set(assignment); !ok) return pass(ok);
  }
  return root;
}

}  // namespace chorus::service
