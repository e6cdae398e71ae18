#include "common/net/host_name.h"

#include <unistd.h>

#include <algorithm>
#include <array>

namespace chorus::net {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

std::vector<std::string> names_of(const std::string& host_name) {
  std::vector<std::string> names;
  const std::string first = host_name.substr(0, host_name.find('.'));
  if (first.empty()) return names;
  for (const std::string& name : {host_name, first, first + ".local"}) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

}  // namespace chorus::net
