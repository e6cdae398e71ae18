#include "common/motion/c3d_parameters.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace chorus::motion {
namespace {

constexpr std::uint8_t kKey = 0x50;  // The second byte of every C3D file.
constexpr std::uint8_t kFirstProcessor = 84;
constexpr std::array<std::string_view, 3> kProcessors{"Intel", "DEC", "MIPS"};

std::string trimmed(std::string_view text) {
  const std::size_t end = text.find_last_not_of(std::string_view(" \t\0", 3));
  return std::string(text.substr(0, end == std::string_view::npos ? 0 : end + 1));
}

}  // namespace

std::string upper(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return out;
}

Result<C3dParameters> C3dParameters::read(std::string_view bytes, std::string_view origin) {
  C3dParameters out(bytes, origin);
  if (const auto ok = out.read_processor(); !ok) return pass(ok);
  if (const auto ok = out.read_parameters(); !ok) return pass(ok);
  return out;
}

std::string C3dParameters::processor_name() const { return std::string(kProcessors[processor_]); }

bool C3dParameters::has_group(std::string_view name) const {
  return std::any_of(groups_.begin(), groups_.end(),
                     [&](const auto& group) { return group.second == name; });
}

Result<void> C3dParameters::read_processor() {
  if (bytes_.size() < 2 * kC3dBlock) return wrong("is too short for a C3D file");
  const auto first = static_cast<std::uint8_t>(bytes_[0]);
  if (static_cast<std::uint8_t>(bytes_[1]) != kKey || first < 2)
    return wrong("does not begin as a C3D file does");
  parameters_at_ = (first - 1u) * kC3dBlock;
  if (parameters_at_ + kC3dBlock > bytes_.size())
    return wrong("has its parameters beyond its end; is it cut off?");
  const auto processor = static_cast<std::uint8_t>(bytes_[parameters_at_ + 3]);
  if (processor < kFirstProcessor ||
      processor - kFirstProcessor >= static_cast<int>(kProcessors.size()))
    return fail(ErrorCode::Unsupported, origin_,
                "names a processor that is neither Intel, DEC nor MIPS");
  processor_ = static_cast<Processor>(processor - kFirstProcessor);
  return {};
}

Result<void> C3dParameters::read_parameters() {
  const std::size_t blocks = static_cast<std::uint8_t>(bytes_[parameters_at_ + 2]);
  // Some writers leave the count at 0; then the list of parameters ends by its own mark.
  const std::size_t end =
      std::min(bytes_.size(), parameters_at_ + (blocks == 0 ? 255 : blocks) * kC3dBlock);
  std::size_t at = parameters_at_ + 4;
  while (at != 0 && at + 2 <= end && bytes_[at] != 0 && bytes_[at + 1] != 0) {
    const auto next = read_entry(at, end);
    if (!next) return pass(next);
    at = *next;
  }
  for (Entry& entry : entries_) {
    if (const auto found = groups_.find(entry.group); found != groups_.end())
      parameters_.emplace(found->second + ":" + entry.name, std::move(entry.parameter));
  }
  return {};
}

/// Reads one group (negative number) or parameter; returns the next one's offset, 0 after the last.
Result<std::size_t> C3dParameters::read_entry(std::size_t at, std::size_t end) {
  const Numbers numbers(bytes_, processor_);
  // A negative length of the name means "locked".
  const auto length = static_cast<std::size_t>(std::abs(numbers.small(at)));
  const int group = numbers.small(at + 1);
  if (at + 2 + length + 2 > end) return wrong("has a parameter that is cut off");
  std::string name = upper(numbers.text(at + 2, length));
  const std::size_t link = at + 2 + length;
  const std::size_t step = numbers.word(link);
  if (group < 0) {
    groups_.emplace(-group, std::move(name));
  } else {
    auto parameter = read_parameter(link + 2, end);
    if (!parameter) return wrong("has a parameter " + name + " that reaches beyond the parameters");
    entries_.push_back({group, std::move(name), std::move(*parameter)});
  }
  return step == 0 ? 0 : link + step;
}

Result<C3dParameters::Parameter> C3dParameters::read_parameter(std::size_t at,
                                                               std::size_t end) const {
  const Numbers numbers(bytes_, processor_);
  if (at + 2 > end) return wrong("is cut off");
  Parameter out;
  out.type = numbers.small(at);
  const std::size_t dimensions = numbers.byte(at + 1);
  if (at + 2 + dimensions > end || dimensions > 7) return wrong("is cut off");
  out.at = at + 2 + dimensions;
  out.count = 1;
  for (std::size_t d = 0; d < dimensions; ++d) {
    out.dimensions.push_back(numbers.byte(at + 2 + d));
    out.count *= out.dimensions.back();
    if (out.count > bytes_.size()) return wrong("is cut off");
  }
  const auto width = static_cast<std::size_t>(std::abs(out.type));
  if (out.at + out.count * width > end) return wrong("is cut off");
  return out;
}

std::optional<double> C3dParameters::number(const std::string& name, std::size_t i) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || i >= found->second.count) return std::nullopt;
  const Numbers numbers(bytes_, processor_);
  const std::size_t at = found->second.at;
  switch (found->second.type) {
    case 1:
      return numbers.byte(at + i);
    case 2:
      return numbers.word(at + 2 * i);  // Counts above 32767 are stored unsigned.
    case 4:
      return numbers.real(at + 4 * i);
    default:
      return std::nullopt;
  }
}

std::vector<std::string> C3dParameters::texts(const std::string& name) const {
  const auto found = parameters_.find(name);
  if (found == parameters_.end() || found->second.type != -1) return {};
  const Parameter& text = found->second;
  if (text.dimensions.empty() || text.dimensions[0] == 0) return {};
  std::vector<std::string> out;
  for (std::size_t i = 0; i + text.dimensions[0] <= text.count; i += text.dimensions[0])
    out.push_back(trimmed(bytes_.substr(text.at + i, text.dimensions[0])));
  return out;
}

}  // namespace chorus::motion
