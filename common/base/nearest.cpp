#include "common/base/nearest.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace chorus {
namespace {

/// Longer words are not compared: the cost is quadratic, and no key is that long.
constexpr std::size_t kMaxWord = 64;

std::size_t allowed_distance(std::size_t longer) {
  return longer < 4 ? 1 : std::max<std::size_t>(2, longer / 3);
}

}  // namespace

std::size_t levenshtein(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // distance from a[0, i) to every prefix of b
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row[b.size()];
}

std::string nearest(std::string_view word, std::span<const std::string> known) {
  if (word.size() > kMaxWord) return {};
  std::string best;
  std::size_t least = kMaxWord + 1;
  for (const std::string& candidate : known) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (longer > kMaxWord) continue;
    const std::size_t distance = levenshtein(word, candidate);
    if (distance > allowed_distance(longer) || distance >= longer || distance >= least) continue;
    best = candidate;
    least = distance;
  }
  return best;
}

}  // namespace chorus
