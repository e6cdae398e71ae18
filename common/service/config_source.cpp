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

}  // namespace

Result<ConfigReader> read_config(const ConfigSource& source) {
  const auto text = text_of(source.path);
  if (!text) return pass(text);
  const std::string assigned = source.assignments.empty() ? "defaults" : "--set";
  auto root = ConfigReader::parse(*text, source.path.empty() ? assigned : source.path);
  if (!root) return root;
  for (const std::string& assignment : source.assignments) {
    if (auto ok = root->set(assignment); !ok) return pass(ok);
  }
  return root;
}

}  // namespace chorus::service
