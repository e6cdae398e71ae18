#include "fusion-server/outlet/allowed_clients.h"

#include <string>
#include <utility>
#include <vector>

namespace chorus::outlet {

void read_allow(ConfigReader& reader, net::AllowList& out) {
  std::vector<std::string> entries;
  reader.read("allow", entries);
  if (auto list = net::AllowList::parse(entries)) {
    out = std::move(*list);
  } else {
    reader.complain("allow", to_string(list.error()));
  }
}

}  // namespace chorus::outlet
