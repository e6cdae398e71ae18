#include "common/suit/mxtp_decoder.h"

#include <algorithm>
#include <array>

#include "common/geometry/rotation.h"
#include "common/sensor/limits.h"
#include "common/suit/big_endian_reader.h"
#include "common/suit/mxtp_segments.h"

namespace chorus::suit {
namespace {

constexpr std::uint32_t kAllSegments = (1U << kMxtpSegmentCount) - 1U;
constexpr std::size_t kMostText = 4096;  // Longest meta data that is read [bytes].
// Least and largest norm of a rotation: MVN sends single precision, some senders round to percent.
constexpr double kLeastNorm = 0.95;
constexpr double kLargestNorm = 1.05;

/// Points of a person of 1.75 m, used until the stream states the person's own (type 13) [m].
struct DefaultPoint {
  std::string_view segment;
  std::string_view label;
  std::array<double, 3> place;
};
constexpr std::array kDefaultPoints{
    DefaultPoint{"Neck", "jC1Head", {0.0, 0.0, 0.10}},
    DefaultPoint{"Head", "pTopOfHead", {0.0, 0.0, 0.18}},
    DefaultPoint{"LeftHand", "pLeftTopOfHand", {0.0, 0.19, 0.0}},
    DefaultPoint{"RightHand", "pRightTopOfHand", {0.0, -0.19, 0.0}},
};

motion::Mvnx person_of_default_size() {
  motion::Mvnx person;
  for (const MxtpSegment& segment : kMxtpSegments) {
    person.segments.push_back({std::string(segment.name), {}});
    for (const DefaultPoint& point : kDefaultPoints) {
      if (point.segment == segment.name)
        person.segments.back().points.push_back(
            {std::string(point.label), Eigen::Vector3d(point.place.data())});
    }
  }
  motion::MvnxFrame frame;
  frame.positions.resize(kMxtpSegmentCount, Eigen::Vector3d::Zero());
  frame.orientations.resize(kMxtpSegmentCount, Eigen::Quaterniond::Identity());
  person.frames.push_back(std::move(frame));
  return person;
}

struct Item {
  std::uint32_t id = 0;
  Eigen::Vector3d position;  ///< z up, x ahead [m]
  Eigen::Quaterniond turn;
};

Item quaternion_item(BigEndianReader& reader) {
  Item item;
  item.id = reader.number(4);
  for (int i = 0; i < 3; ++i) item.position[i] = reader.real();
  const double w = reader.real();
  const double x = reader.real();
  const double y = reader.real();
  const double z = reader.real();
  item.turn = Eigen::Quaterniond(w, x, y, z);
  return item;
}

/// Type 01: centimetres, y up, z ahead, x to the left.
Item euler_item(BigEndianReader& reader) {
  Item item;
  item.id = reader.number(4);
  const double left = reader.real();
  const double up = reader.real();
  const double ahead = reader.real();
  for (int angle = 0; angle < 3; ++angle) reader.real();
  item.position = Eigen::Vector3d(ahead, left, up) / 100.0;
  item.turn = Eigen::Quaterniond::Identity();
  return item;
}

Result<void> check(const Item& item) {
  const bool near =
      item.position.allFinite() && item.position.cwiseAbs().maxCoeff() < kMaxCoordinate;
  if (!near)
    return fail(ErrorCode::Malformed, "MXTP segment " + std::to_string(item.id),
                "its position is not finite, or farther than 10 km");
  const double norm = item.turn.norm();
  if (!(norm > kLeastNorm && norm < kLargestNorm))
    return fail(ErrorCode::Malformed, "MXTP segment " + std::to_string(item.id),
                "its rotation is no unit quaternion");
  return {};
}

/// "name:Anna\nxmid:12\n": the value of the line "name:".
std::string name_in(std::string_view text) {
  text = text.substr(0, std::min(text.size(), kMostText));
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.starts_with("name:")) return std::string(line.substr(5, 100));
  }
  return {};
}

/// Reads the points of type 13, which follow the segments; replaces those that the person has.
void read_scale(std::span<const char> payload, motion::Mvnx& person) {
  BigEndianReader reader(payload);
  const std::uint32_t segments = reader.number(4);
  for (std::uint32_t i = 0; i < segments && reader.ok(); ++i) {
    reader.text(reader.number(4));
    for (int axis = 0; axis < 3; ++axis) reader.real();
  }
  const std::uint32_t points = reader.number(4);
  for (std::uint32_t i = 0; i < points && reader.ok(); ++i) {
    const std::uint32_t segment = reader.number(2);
    reader.number(2);
    const std::string label(reader.text(reader.number(4)));
    reader.number(4);
    Eigen::Vector3d place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = reader.real();
    if (!reader.ok() || segment < 1 || segment > kMxtpSegmentCount) continue;
    // A point of a body segment is within a metre of its origin.
    if (!place.allFinite() || place.norm() > 1.0) continue;
    for (motion::MvnxPoint& known : person.segments[segment - 1].points) {
      if (known.label == label) known.in_segment = place;
    }
  }
}

}  // namespace

Result<MxtpDecoder::Character*> MxtpDecoder::character(int id) {
  const auto known = people_.find(id);
  if (known != people_.end()) return &known->second;
  if (people_.size() >= kMostCharacters)
    return fail(ErrorCode::TooLarge, "MXTP character " + std::to_string(id),
                "a stream has at most eight people");
  Character fresh;
  fresh.mvnx = person_of_default_size();
  return &people_.emplace(id, std::move(fresh)).first->second;
}

void MxtpDecoder::begin(const MxtpDatagram& datagram, Character& person) {
  if (!person.finished) ++incomplete_;
  person.sample = datagram.sample;
  person.parts = 0;
  person.last.reset();
  person.segments = 0;
  person.finished = false;
}

Result<std::optional<MxtpPose>> MxtpDecoder::segments(const MxtpDatagram& datagram,
                                                      Character& person) {
  constexpr int kMostParts = 32;
  if (datagram.part >= kMostParts)
    return fail(ErrorCode::TooLarge, "MXTP", "a sample has at most 32 parts");
  // Repeated, or sent as quaternions and as Euler angles.
  if (person.finished && person.done == datagram.sample) return std::nullopt;
  if (person.finished || person.sample != datagram.sample) begin(datagram, person);
  BigEndianReader reader(datagram.payload);
  const bool euler = datagram.type == static_cast<int>(MxtpType::Euler);
  motion::MvnxFrame& frame = person.mvnx.frames.front();
  for (int i = 0; i < datagram.items; ++i) {
    const Item item = euler ? euler_item(reader) : quaternion_item(reader);
    if (item.id < 1 || item.id > kMxtpSegmentCount) continue;  // props and fingers
    if (const auto ok = check(item); !ok) return pass(ok);
    frame.positions[item.id - 1] = item.position;
    frame.orientations[item.id - 1] = item.turn.normalized();
    person.segments |= 1U << (item.id - 1);
  }
  person.parts |= 1U << datagram.part;
  if (datagram.last) person.last = datagram.part;
  const auto wanted = person.last ? (std::uint64_t{2} << *person.last) - 1 : 0;
  if (!person.last || (person.parts & wanted) != wanted) return std::nullopt;
  person.finished = true;
  person.done = datagram.sample;
  if (person.segments != kAllSegments)
    return fail(ErrorCode::Malformed, "MXTP", "a sample lacks some of the 23 body segments");
  const auto motion = motion::motion_from_mvnx(person.mvnx);
  if (!motion) return pass(motion);
  MxtpPose pose{datagram.character, person.name, datagram.sample, datagram.time_ms,
                motion->frames.front()};
  if (euler) motion::orient_segments(pose.body);
  return pose;
}

Result<std::optional<MxtpPose>> MxtpDecoder::take(std::span<const char> bytes) {
  const auto datagram = read_mxtp(bytes);
  if (!datagram) return pass(datagram);
  const auto is = [&](MxtpType type) { return datagram->type == static_cast<int>(type); };
  const bool pose = is(MxtpType::Euler) || is(MxtpType::Quaternion);
  if (!pose && !is(MxtpType::Meta) && !is(MxtpType::Scale)) return std::nullopt;
  const auto person = character(datagram->character);
  if (!person) return pass(person);
  if (pose) return segments(*datagram, **person);
  const std::span<const char> payload = datagram->payload;
  if (is(MxtpType::Meta)) (*person)->name = name_in({payload.data(), payload.size()});
  if (is(MxtpType::Scale)) read_scale(payload, (*person)->mvnx);
  return std::nullopt;
}

}  // namespace chorus::suit
