#include "common/exporters/c3d.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "common/base/units.h"
#include "common/body/bones.h"

namespace chorus::exporters {
namespace {

constexpr std::size_t kBlock = 512;
// Largest number of blocks for the parameters, because one byte counts them.
constexpr std::size_t kMaxBlocks = 255;
constexpr std::size_t kMaxPersons = 100;
constexpr std::size_t kLabelsPerParameter = 255;  // A dimension is stored in a byte.
constexpr std::size_t kMaxFrames = 65535;         // The limit of a 16-bit word.
constexpr char kKey = 0x50;
constexpr char kIntel = 84;
/// POINT:SCALE.  Negative: coordinates are floats.  The magnitude is the unit of residuals [mm].
constexpr float kFloatsInMillimetres = -1.0f;
constexpr int kMaxResidual = 255;

void append_word(std::string& bytes, std::size_t value) {
  bytes += static_cast<char>(value & 0xff);
  bytes += static_cast<char>(value >> 8 & 0xff);
}

void append_float(std::string& bytes, float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  append_word(bytes, bits & 0xffff);
  append_word(bytes, bits >> 16);
}

/// A parameter's type, dimensions and values.
struct Content {
  int type = 2;  ///< -1: text, 1: bytes, 2: words, 4: floats.
  std::vector<std::size_t> dimensions;
  std::string values;
};

Content word(std::size_t value) {
  Content content{2, {}, {}};
  append_word(content.values, value);
  return content;
}

/// A 32-bit count as two 16-bit words, which is how TRIAL stores it.
Content two_words(std::size_t value) {
  Content content{2, {2}, {}};
  append_word(content.values, value & 0xffff);
  append_word(content.values, value >> 16);
  return content;
}

Content real(double value) {
  Content content{4, {}, {}};
  append_float(content.values, static_cast<float>(value));
  return content;
}

Content text(std::string_view value) { return {-1, {value.size()}, std::string(value)}; }

/// A column of strings, padded with blanks.
Content texts(const std::vector<std::string>& values) {
  std::size_t longest = 1;
  for (const std::string& value : values) longest = std::max(longest, value.size());
  Content content{-1, {longest, values.size()}, {}};
  for (const std::string& value : values) {
    content.values += value;
    content.values.append(longest - value.size(), ' ');
  }
  return content;
}

class Parameters {
 public:
  void group(std::string_view name) {
    ++group_;
    entry(-group_, name, "");
  }

  void add(std::string_view name, const Content& content) {
    std::string body(1, static_cast<char>(content.type));
    body += static_cast<char>(content.dimensions.size());
    for (const std::size_t dimension : content.dimensions) body += static_cast<char>(dimension);
    entry(group_, name, body + content.values);
  }

  /// All blocks, including the parameter header.
  [[nodiscard]] std::string bytes() const {
    std::string all = std::string(4, '\0') + entries_;
    all.append(2, '\0');  // an entry without a name ends the list
    all.resize((all.size() + kBlock - 1) / kBlock * kBlock, '\0');
    all[0] = 1;
    all[1] = kKey;
    all[2] = static_cast<char>(all.size() / kBlock);
    all[3] = kIntel;
    return all;
  }

 private:
  /// Appends an entry: length of the name, number, name, offset to the next entry, content, and an
  /// empty description.
  void entry(int number, std::string_view name, std::string_view content) {
    entries_ += static_cast<char>(name.size());
    entries_ += static_cast<char>(number);
    entries_ += name;
    append_word(entries_, 2 + content.size() + 1);
    entries_ += content;
    entries_ += '\0';
  }

  int group_ = 0;
  std::string entries_;
};

std::vector<std::string> labels_of(const Take& take) {
  std::vector<std::string> labels;
  for (const PersonTrack& track : take.persons) {
    const std::string prefix = prefix_of(take, track, ":");
    for (const std::string_view name : kJointNames) labels.push_back(prefix + std::string(name));
  }
  return labels;
}

void add_points(Parameters& parameters, const Take& take, std::size_t data_start) {
  const std::vector<std::string> labels = labels_of(take);
  parameters.group("POINT");
  parameters.add("USED", word(labels.size()));
  parameters.add("SCALE", real(kFloatsInMillimetres));
  parameters.add("RATE", real(take.rate_hz));
  parameters.add("DATA_START", word(data_start));
  parameters.add("FRAMES", word(std::min(take.frames, kMaxFrames)));
  if (take.frames >= kMaxFrames)
    parameters.add("LONG_FRAMES", real(static_cast<double>(take.frames)));
  for (std::size_t first = 0; first < labels.size(); first += kLabelsPerParameter) {
    const auto begin = labels.begin() + static_cast<std::ptrdiff_t>(first);
    const auto count = std::min(kLabelsPerParameter, labels.size() - first);
    const std::vector part(begin, begin + static_cast<std::ptrdiff_t>(count));
    const std::size_t number = first / kLabelsPerParameter + 1;
    const std::string suffix = number > 1 ? std::to_string(number) : "";
    parameters.add("LABELS" + suffix, texts(part));
    parameters.add("DESCRIPTIONS" + suffix, texts(part));
  }
  parameters.add("UNITS", text("mm"));
  parameters.add("X_SCREEN", text("+X"));
  parameters.add("Y_SCREEN", text("+Y"));
}

void add_persons(Parameters& parameters, const Take& take) {
  if (take.persons.size() < 2) return;
  std::vector<std::string> names;
  for (const PersonTrack& track : take.persons)
    names.push_back("P" + std::to_string(track.person.value));
  parameters.group("SUBJECTS");
  parameters.add("USED", word(names.size()));
  parameters.add("NAMES", texts(names));
  for (std::string& name : names) name += ':';
  parameters.add("LABEL_PREFIXES", texts(names));
}

std::string parameters_of(const Take& take, std::size_t data_start) {
  Parameters parameters;
  add_points(parameters, take, data_start);
  parameters.group("ANALOG");
  parameters.add("USED", word(0));
  parameters.add("GEN_SCALE", real(1.0));
  // There are no analog samples, so their rate is 0; py-c3d compares it with the header.
  parameters.add("RATE", real(0.0));
  for (const std::string_view name : {"LABELS", "DESCRIPTIONS", "UNITS"})
    parameters.add(name, {-1, {0, 0}, {}});
  parameters.add("SCALE", {4, {0}, {}});
  parameters.add("OFFSET", {2, {0}, {}});
  parameters.group("FORCE_PLATFORM");
  parameters.add("USED", word(0));
  parameters.group("TRIAL");
  parameters.add("ACTUAL_START_FIELD", two_words(1));
  parameters.add("ACTUAL_END_FIELD", two_words(take.frames));
  parameters.group("MANUFACTURER");
  parameters.add("SOFTWARE", text("Chorus"));
  add_persons(parameters, take);
  return parameters.bytes();
}

std::string header_of(const Take& take, std::size_t data_start) {
  std::string header;
  header += 2;  // block at which the parameters begin
  header += kKey;
  append_word(header, take.persons.size() * kJointCount);
  append_word(header, 0);  // analog samples per frame
  append_word(header, 1);  // first frame
  append_word(header, std::min(take.frames, kMaxFrames));
  append_word(header, 0);  // longest gap that was interpolated
  append_float(header, kFloatsInMillimetres);
  append_word(header, data_start);
  append_word(header, 0);  // analog samples per channel
  append_float(header, static_cast<float>(take.rate_hz));
  header.resize(kBlock, '\0');
  return header;
}

void append_point(std::string& bytes, const Joint& joint, double variance) {
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    append_float(bytes, joint.seen() ? static_cast<float>(to_mm(joint.position[axis])) : 0.0f);
  float residual = -1.0f;
  if (joint.seen()) {
    const double millimetres = variance >= 0 ? to_mm(std::sqrt(3 * variance)) : 0.0;
    const double whole = std::clamp(std::round(millimetres), variance >= 0 ? 1.0 : 0.0,
                                    static_cast<double>(kMaxResidual));
    residual = static_cast<float>(whole);
  }
  append_float(bytes, residual);
}

}  // namespace

Result<std::string> c3d_of(const Take& take) {
  if (take.persons.size() > kMaxPersons)
    return fail(ErrorCode::TooLarge, "C3D", "cannot name the joints of more than 100 persons.");
  // The length of the parameters does not depend on the block number that they contain.
  const std::size_t blocks = parameters_of(take, 0).size() / kBlock;
  if (blocks > kMaxBlocks)
    return fail(ErrorCode::TooLarge, "C3D",
                "has no room for the names of so many persons with such long ids; export some of "
                "them: --person ID.");
  const std::size_t data_start = 2 + blocks;
  std::string bytes = header_of(take, data_start) + parameters_of(take, data_start);
  for (std::size_t f = 0; f < take.frames; ++f) {
    for (const PersonTrack& track : take.persons) {
      const Pose& pose = track.poses[f];
      for (std::size_t j = 0; j < kJointCount; ++j)
        append_point(bytes, pose.skeleton.joints[j], pose.variance[j]);
    }
  }
  bytes.resize((bytes.size() + kBlock - 1) / kBlock * kBlock, '\0');
  return bytes;
}

}  // namespace chorus::exporters
