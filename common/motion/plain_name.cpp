// Reduces the names of other programs to a side and a stem (joint_names.h).
#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "common/motion/joint_names.h"

namespace chorus::motion {
namespace {

constexpr std::array<std::string_view, 4> kLeftWords{"l", "left", "lt", "lft"};
constexpr std::array<std::string_view, 5> kRightWords{"r", "right", "rt", "rgt", "rht"};
/// Words that programs add to every bone, or to those in the middle.
constexpr std::array<std::string_view, 9> kNoise{"jnt", "joint", "bone", "bn", "def",
                                                 "org", "jt",    "m",    "c"};
constexpr double kShared = 0.6;
constexpr std::string_view kSeparators = "_:.| -";

bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }
bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

template <std::size_t count>
bool is_one_of(const std::array<std::string_view, count>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// True where a new word begins within a run of letters and digits: "leftArm", "LUArm".
bool begins_word(std::string_view run, std::size_t i) {
  if (!is_upper(run[i])) return false;
  if (is_lower(run[i - 1]) || is_digit(run[i - 1])) return true;
  return i + 1 < run.size() && is_lower(run[i + 1]) && is_upper(run[i - 1]);
}

/// True if the first letter of the run is a side: "LThigh", "rShldr", "LUArm", not "LASI".
bool begins_with_side(std::string_view run) {
  if (run.size() < 3 || std::string_view("LRlr").find(run[0]) == std::string_view::npos)
    return false;
  return is_upper(run[1]) && std::any_of(run.begin() + 1, run.end(), is_lower);
}

/// True if the last letter of the run is a side: "ASISr".
bool ends_with_side(std::string_view run) {
  return run.size() > 3 && (run.back() == 'l' || run.back() == 'r') &&
         std::all_of(run.begin(), run.end() - 1, is_upper);
}

void add_words(std::string_view run, std::vector<std::string>& words) {
  if (run.empty()) return;
  if (ends_with_side(run)) {
    words.push_back(lower(run.substr(0, run.size() - 1)));
    words.push_back(lower(run.substr(run.size() - 1)));
    return;
  }
  if (begins_with_side(run)) {
    words.push_back(lower(run.substr(0, 1)));
    run.remove_prefix(1);
  }
  std::size_t begin = 0;
  for (std::size_t i = 1; i < run.size(); ++i) {
    if (!begins_word(run, i)) continue;
    words.push_back(lower(run.substr(begin, i - begin)));
    begin = i;
  }
  words.push_back(lower(run.substr(begin)));
}

std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  while (!name.empty()) {
    const auto end = static_cast<std::size_t>(std::find_if_not(name.begin(), name.end(), is_word) -
                                              name.begin());
    add_words(name.substr(0, end), words);
    name.remove_prefix(std::min(name.size(), end + 1));
  }
  return words;
}

/// Cuts "left" or "right" off either end of a stem such as "leftuparm" or "handright".
char cut_side(std::string& stem) {
  for (const auto& [word, side] : {std::pair{std::string_view("left"), 'l'}, {"right", 'r'}}) {
    if (stem.size() > word.size() && stem.starts_with(word)) {
      stem.erase(0, word.size());
      return side;
    }
    if (stem.size() > word.size() && stem.ends_with(word)) {
      stem.erase(stem.size() - word.size());
      return side;
    }
  }
  return 0;
}

/// "01" -> "1": programs number the same bones with and without zeros.
std::string without_zeros(std::string text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool leads = text[i] == '0' && (i == 0 || !is_digit(text[i - 1])) &&
                       i + 1 < text.size() && is_digit(text[i + 1]);
    if (!leads) out += text[i];
  }
  return out;
}

/// The part of a name up to its first separator, which included; "" if there is none, or if it is
/// a side.
std::string prefix_of(const std::string& name) {
  const auto end = name.find_first_of(kSeparators);
  if (end == std::string::npos || end + 1 >= name.size()) return "";
  const std::string word = lower(std::string_view(name).substr(0, end));
  if (is_one_of(kLeftWords, word) || is_one_of(kRightWords, word)) return "";
  return name.substr(0, end + 1);
}

}  // namespace

std::string plain_name(std::string_view name) {
  char side = 0;
  std::string stem;
  const std::vector<std::string> words = words_of(name);
  for (const std::string& word : words) {
    const bool left = is_one_of(kLeftWords, word);
    if (side == 0 && words.size() > 1 && (left || is_one_of(kRightWords, word))) {
      side = left ? 'l' : 'r';
    } else if (words.size() == 1 || !is_one_of(kNoise, word)) {
      stem += without_zeros(word);
    }
  }
  if (side == 0) side = cut_side(stem);
  return (side == 0 ? std::string() : std::string(1, side)) + "." + stem;
}

std::vector<std::string> without_common_prefix(std::vector<std::string> names) {
  constexpr int kMostPrefixes = 3;
  for (int round = 0; round < kMostPrefixes; ++round) {
    std::map<std::string, std::size_t> counts;
    for (const std::string& name : names) ++counts[prefix_of(name)];
    counts.erase("");
    const auto most = std::max_element(counts.begin(), counts.end(),
                                       [](auto& a, auto& b) { return a.second < b.second; });
    if (most == counts.end() || names.size() < 3 ||
        static_cast<double>(most->second) < kShared * static_cast<double>(names.size()))
      break;
    for (std::string& name : names) {
      if (name.starts_with(most->first)) name.erase(0, most->first.size());
    }
  }
  return names;
}

}  // namespace chorus::motion
