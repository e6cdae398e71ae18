#include "common/ergonomics/table.h"

#include <sstream>

#include <fmt/format.h>

#include "common/base/parse.h"
#include "printed_tables.h"

namespace chorus::ergonomics {
namespace {

Error bad_line(std::string_view file, int line, std::string message) {
  return {ErrorCode::Malformed, fmt::format("{}:{}", file, line), std::move(message)};
}

/// "A upper_arm 6 lower_arm 3": the name and the sizes.
Result<std::pair<std::string, std::array<std::size_t, 4>>> head_of(std::istringstream& words) {
  std::pair<std::string, std::array<std::size_t, 4>> head{{}, {1, 1, 1, 1}};
  words >> head.first;
  std::string axis;
  std::size_t size = 0;
  for (std::size_t i = 0; words >> axis; ++i) {
    if (i >= head.second.size() || !(words >> size) || size == 0)
      return fail(ErrorCode::Malformed, axis, "needs a size; at most four axes");
    head.second[i] = size;
  }
  return head;
}

const Table& named(const NamedTables& tables, std::string_view name) {
  static const Table kEmpty;
  for (const auto& [each, table] : tables) {
    if (each == name) return table;
  }
  return kEmpty;
}

NamedTables embedded(std::string_view text, std::string_view file) {
  return read_tables(text, file).value_or(NamedTables{});
}

PrintedTables read_printed() {
  const auto rula = embedded(printed::rula, "rula.txt");
  const auto reba = embedded(printed::reba, "reba.txt");
  const auto owas = embedded(printed::owas, "owas.txt");
  const auto niosh = embedded(printed::niosh, "niosh.txt");
  return {named(rula, "A"),  named(rula, "B"),   named(rula, "C"),
          named(reba, "A"),  named(reba, "B"),   named(reba, "C"),
          named(owas, "AC"), named(niosh, "FM"), named(niosh, "CM")};
}

}  // namespace

Result<NamedTables> read_tables(std::string_view text, std::string_view file) {
  NamedTables tables;
  std::istringstream lines{std::string(text)};
  std::string line;
  const auto complete = [&](int at) -> Result<void> {
    if (tables.empty()) return {};
    const auto& [name, table] = tables.back();
    const auto& sizes = table.sizes();
    const std::size_t wanted = sizes[0] * sizes[1] * sizes[2] * sizes[3];
    if (table.cells().size() == wanted) return {};
    return tl::unexpected<Error>(
        bad_line(file, at,
                 fmt::format("table {} has {} cells, not {}", name, table.cells().size(), wanted)));
  };
  int number = 0;
  for (; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    while (words >> word) {
      if (word == "table") {
        if (auto ok = complete(number); !ok) return pass(ok);
        auto head = head_of(words);
        if (!head) return tl::unexpected<Error>(bad_line(file, number + 1, head.error().message));
        auto& [name, table] = tables.emplace_back(head->first, Table{});
        table.sizes_ = head->second;
        table.cells_.clear();
        break;
      }
      const auto cell = parse_number<int>(word);
      if (!cell || tables.empty())
        return tl::unexpected<Error>(
            bad_line(file, number + 1, fmt::format("'{}' is no cell", word)));
      tables.back().second.cells_.push_back(*cell);
    }
  }
  if (auto ok = complete(number); !ok) return pass(ok);
  return tables;
}

const PrintedTables& printed_tables() {
  static const PrintedTables kTables = read_printed();
  return kTables;
}

}  // namespace chorus::ergonomics
