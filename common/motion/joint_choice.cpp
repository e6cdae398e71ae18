// The file that says which points make which joints (--joints), and its template.
#include <algorithm>

#include "common/base/nearest.h"
#include "common/motion/joint_names.h"

namespace chorus::motion {
namespace {

constexpr std::string_view kTrimmed = " \t\r";

std::string trimmed_word(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kTrimmed);
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(kTrimmed) - begin + 1));
}

std::vector<std::string> listed(std::string_view text) {
  std::vector<std::string> names;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    std::string name = trimmed_word(text.substr(0, end));
    if (!name.empty()) names.push_back(std::move(name));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return names;
}

Result<void> read_choice(std::string_view line, const std::string& at, JointChoice& out) {
  const std::string text = trimmed_word(line.substr(0, line.find('#')));
  if (text.empty()) return {};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos)
    return fail(ErrorCode::Malformed, at, "must be JOINT = NAME, or JOINT = NAME, NAME");
  const std::string word = trimmed_word(std::string_view(text).substr(0, equals));
  const auto joint = joint_named(word);
  if (!joint) {
    const std::vector<std::string> names(kJointNames.begin(), kJointNames.end());
    const std::string meant = nearest(word, names);
    return fail(ErrorCode::Malformed, at,
                "\"" + word.substr(0, 40) + "\" is no joint of ours" +
                    (meant.empty() ? "" : "; did you mean " + meant + "?"));
  }
  auto names = listed(std::string_view(text).substr(equals + 1));
  if (names.empty()) return {};
  if (!out.emplace(*joint, std::move(names)).second)
    return fail(ErrorCode::Malformed, at, word + " is there twice");
  return {};
}

}  // namespace

Result<JointChoice> parse_joint_choice(std::string_view text, std::string_view origin) {
  JointChoice out;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string at = std::string(origin) + ":" + std::to_string(line);
    if (auto ok = read_choice(text.substr(0, end), at, out); !ok) return pass(ok);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string joint_choice_template(const std::vector<std::string>& names,
                                  const JointSources& found) {
  std::string text =
      "# Which points of the file make which joint; several, separated by commas: their mean.\n"
      "# An empty right side leaves the joint to Chorus.  The file has:\n";
  for (const std::string& name : names) text += "#   " + name + "\n";
  for (std::size_t j = 0; j < kJointCount; ++j) {
    text += std::string(kJointNames[j]) + " =";
    const JointSource& source = found[j];
    for (std::size_t i = 0; i < source.points.size() && source.placing == Placing::Mean; ++i)
      text += (i == 0 ? " " : ", ") + names[source.points[i]];
    text += "\n";
  }
  return text;
}

std::string names_shown(const std::vector<std::string>& names) {
  constexpr std::size_t kMostShown = 60;
  constexpr std::size_t kMostOfName = 32;
  std::string text;
  for (std::size_t i = 0; i < std::min(kMostShown, names.size()); ++i)
    text += (i == 0 ? "" : ", ") + names[i].substr(0, kMostOfName);
  return names.size() > kMostShown ? text + ", ..." : text;
}

}  // namespace chorus::motion
