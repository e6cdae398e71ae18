#include "common/service/config_source.h"

#include "common/base/file.h"

namespace chorus::service {
namespace {

Result<std::string> text_of(const std::string& path) {
  constexpr std::uintmax_t kMaxBytes = 16u << 20;
  if (path.empty()) return std::string("{}");
  auto text = read_file(path, kMaxBytes);
  if (text) return text;
  return fail(ErrorCode::Io, path,
              "the configuration file cannot be read: " + text.error().message);
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
