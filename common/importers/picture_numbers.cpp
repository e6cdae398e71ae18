#include "common/importers/picture_numbers.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "common/base/parse.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kLongestNumber = 12;

/// Each run of digits in a name.
using Runs = std::vector<std::string>;

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The runs of digits in a name.  `shape` becomes the name with each run replaced by #; in names
/// with the same shape, the runs have the same meaning.
Runs runs_of(const std::string& name, std::string& shape) {
  Runs runs;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool digit = is_digit(name[i]);
    const bool begins = digit && (i == 0 || !is_digit(name[i - 1]));
    if (begins) runs.emplace_back();
    if (digit) runs.back() += name[i];
    if (begins || !digit) shape += begins ? '#' : name[i];
  }
  return runs;
}

std::optional<std::uint64_t> number_of(const std::string& run) {
  return run.size() <= kLongestNumber ? parse_number<std::uint64_t>(run) : std::nullopt;
}

/// The index of the run that numbers these names, which all have the same shape: the last run that
/// differs in all of them, otherwise the longest one; none if no run is a number.
std::optional<std::size_t> numbering_run(const std::vector<const Runs*>& names) {
  const Runs& first = *names.front();
  for (std::size_t run = first.size(); names.size() > 1 && run-- > 0;) {
    std::set<std::uint64_t> seen;
    for (const Runs* name : names) {
      if (const auto number = number_of((*name)[run])) seen.insert(*number);
    }
    if (seen.size() == names.size()) return run;
  }
  std::optional<std::size_t> longest;
  for (std::size_t run = 0; run < first.size(); ++run) {
    const bool longer = !longest || first[run].size() >= first[*longest].size();
    if (longer && number_of(first[run])) longest = run;
  }
  return longest;
}

/// The digits of a name as numbers, from left to right.
std::vector<std::uint64_t> values_of(const Runs& runs) {
  std::vector<std::uint64_t> values;
  for (const std::string& run : runs) values.push_back(number_of(run).value_or(0));
  return values;
}

/// The members in the order of all their digits.
std::vector<std::size_t> in_order(std::vector<std::size_t> members, const std::vector<Runs>& runs) {
  std::stable_sort(members.begin(), members.end(), [&](std::size_t a, std::size_t b) {
    return values_of(runs[a]) < values_of(runs[b]);
  });
  return members;
}

}  // namespace

PictureNumbers picture_numbers(const std::vector<std::string>& names) {
  std::vector<Runs> runs;
  std::map<std::string, std::vector<std::size_t>> alike;  // by shape
  for (std::size_t i = 0; i < names.size(); ++i) {
    std::string shape;
    runs.push_back(runs_of(names[i], shape));
    alike[shape].push_back(i);
  }
  PictureNumbers out{std::vector<std::uint64_t>(names.size())};
  auto& numbers = out.numbers;
  for (const auto& [shape, members] : alike) {
    std::vector<const Runs*> of_members;
    for (const std::size_t i : members) of_members.push_back(&runs[i]);
    const auto run = numbering_run(of_members);
    for (const std::size_t i : members) numbers[i] = run ? number_of(runs[i][*run]).value_or(i) : i;
    const auto ordered = in_order(members, runs);
    const auto goes_back = [&](std::size_t a, std::size_t b) { return numbers[a] > numbers[b]; };
    if (std::adjacent_find(ordered.begin(), ordered.end(), goes_back) == ordered.end()) continue;
    out.by_order = true;
    for (std::size_t k = 0; k < ordered.size(); ++k) numbers[ordered[k]] = k;
  }
  return out;
}

}  // namespace chorus::importers
