// chorus-contract [--check] PROTO_FOLDER: writes the parts of the contract that the table of fields
// determines; with --check, only says which files are not current.
#include <cstdio>
#include <exception>
#include <fstream>
#include <sstream>
#include <string>

#include "tests/contract/contract_text.h"

namespace {

struct Part {
  const char* file;
  std::string (*with)(const std::string&);
};

constexpr Part kParts[]{{"vocab/chorus.ttl", chorus::contract::with_vocabulary},
                        {"shapes.ttl", chorus::contract::with_shapes},
                        {"context.jsonld", chorus::contract::with_context},
                        {"openapi.json", chorus::contract::with_openapi},
                        {"frame.schema.json", chorus::contract::with_schema},
                        {"README.md", chorus::contract::with_readme}};

/// True if the file is, or now is, as the table wants it.
bool settle(const std::string& path, const Part& part, bool check) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  const std::string wanted = part.with(text.str());
  if (wanted == text.str()) return true;
  if (!check && std::ofstream(path, std::ios::binary) << wanted) return true;
  std::fprintf(stderr, "%s is not what the table of fields says: run chorus-contract proto\n",
               path.c_str());
  return false;
}

}  // namespace

int main(int count, char** arguments) {
  const bool check = count == 3 && std::string(arguments[1]) == "--check";
  if (count != (check ? 3 : 2)) {
    std::fprintf(stderr, "usage: chorus-contract [--check] PROTO_FOLDER\n");
    return 2;
  }
  bool current = true;
  try {
    for (const Part& part : kParts)
      current = settle(std::string(arguments[count - 1]) + "/" + part.file, part, check) && current;
  } catch (const std::exception& problem) {
    std::fprintf(stderr, "chorus-contract: %s\n", problem.what());
    return 1;
  }
  return current ? 0 : 1;
}
