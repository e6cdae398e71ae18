#include "common/inertial/slimevr.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

namespace chorus::inertial::slimevr {
namespace {

// clang-format off
enum Type : std::uint32_t { kHeartbeat = 0, kRotation = 1, kHandshake = 3, kAcceleration = 4, kPing = 10, kPong = 10,
                            kBattery = 12, kSensor = 15, kRotationData = 17, kMagnetometer = 18, kBundle = 100 };
// clang-format on
constexpr std::size_t kHandshakeAnswerBytes = 64;
constexpr double kUnitLength = 0.05;  // tolerance: trackers send single precision, some less

/// Reads big-endian numbers; reading beyond the end gives zero and marks it.
class Bytes {
 public:
  explicit Bytes(std::string_view rest) : rest_(rest) {}

  template <class Number>
  Number take() {
    if (rest_.size() < sizeof(Number)) {
      cut_ = true;
      rest_ = {};
      return Number{};
    }
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      bits = bits << 8 | static_cast<unsigned char>(rest_[i]);
    rest_.remove_prefix(sizeof(Number));
    if constexpr (std::is_same_v<Number, float>)
      return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    else
      return static_cast<Number>(bits);
  }
  std::string_view take_text(std::size_t size) {
    cut_ = cut_ || size > rest_.size();
    const std::string_view text = rest_.substr(0, size);
    rest_.remove_prefix(text.size());
    return text;
  }
  Eigen::Vector3d take_vector() {
    const double x = take<float>();
    const double y = take<float>();
    const double z = take<float>();
    return {x, y, z};
  }
  [[nodiscard]] bool cut() const { return cut_; }
  [[nodiscard]] std::size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
  bool cut_ = false;
};

Handshake take_handshake(Bytes& bytes) {
  // Old trackers send none of this; they are served all the same.
  if (bytes.left() == 0) return {};
  Handshake out;
  out.board = bytes.take<std::uint32_t>();
  out.imu = bytes.take<std::uint32_t>();
  out.mcu = bytes.take<std::uint32_t>();
  bytes.take_text(12);
  out.firmware_build = bytes.take<std::int32_t>();
  for (const char c : bytes.take_text(bytes.take<std::uint8_t>()))
    if (c >= 0x20 && c < 0x7f) out.firmware.push_back(c);
  for (std::uint8_t& each : out.mac) each = bytes.take<std::uint8_t>();
  return out;
}

Rotation take_rotation(Bytes& bytes, std::uint8_t sensor) {
  const Eigen::Vector3d v = bytes.take_vector();
  return {sensor, Eigen::Quaterniond(bytes.take<float>(), v.x(), v.y(), v.z())};
}

Battery take_battery(Bytes& bytes) {
  const double first = bytes.take<float>();
  if (bytes.left() < sizeof(float)) return {0.0, first / 100.0};
  return {first, bytes.take<float>()};
}

Content take_content(std::uint32_t type, Bytes& bytes) {
  switch (type) {
    case kHeartbeat:
      return Heartbeat{};
    case kHandshake:
      return take_handshake(bytes);
    case kRotation:
      return take_rotation(bytes, 0);
    case kRotationData: {
      const auto sensor = bytes.take<std::uint8_t>();
      bytes.take<std::uint8_t>();  // normal or correction
      return take_rotation(bytes, sensor);
    }
    case kAcceleration: {
      const Eigen::Vector3d a = bytes.take_vector();
      return Acceleration{bytes.left() > 0 ? bytes.take<std::uint8_t>() : std::uint8_t{0}, a};
    }
    case kPong:
      return Pong{bytes.take<std::int32_t>()};
    case kBattery:
      return take_battery(bytes);
    case kSensor: {
      const auto sensor = bytes.take<std::uint8_t>();
      const auto status = bytes.take<std::uint8_t>();
      return SensorState{sensor, status,
                         bytes.left() > 0 ? bytes.take<std::uint8_t>() : std::uint8_t{0}};
    }
    case kMagnetometer: {
      const auto sensor = bytes.take<std::uint8_t>();
      return MagnetometerAccuracy{sensor, bytes.take<float>()};
    }
    default:
      return Other{type};
  }
}

std::string wrong_with(Content& content) {
  if (auto* const rotation = std::get_if<Rotation>(&content)) {
    const double norm = rotation->world_from_tracker.coeffs().norm();
    if (!(std::abs(norm - 1.0) <= kUnitLength)) return "its rotation is not of unit length";
    rotation->world_from_tracker.coeffs() /= norm;
  }
  const auto* const force = std::get_if<Acceleration>(&content);
  if (force != nullptr && !force->in_tracker.allFinite()) return "its acceleration is not finite";
  if (const auto* const battery = std::get_if<Battery>(&content)) {
    const bool fine =
        battery->charge >= 0 && battery->charge <= 1.01 && std::isfinite(battery->volts);
    if (!fine) return "its battery's charge is not between 0 and 1";
  }
  const auto* const field = std::get_if<MagnetometerAccuracy>(&content);
  if (field != nullptr && !std::isfinite(field->radians)) return "its accuracy is not finite";
  return {};
}

Result<Packet> packet_of(std::uint32_t type, std::uint64_t number, Bytes& bytes) {
  Packet out{number, take_content(type, bytes)};
  const std::string where = "packet of type " + std::to_string(type);
  if (bytes.cut()) return fail(ErrorCode::Malformed, where, "ends too early");
  if (const std::string wrong = wrong_with(out.content); !wrong.empty())
    return fail(ErrorCode::Malformed, where, wrong);
  return out;
}

Result<std::vector<Packet>> unbundled(Bytes& bytes) {
  std::vector<Packet> out;
  while (bytes.left() > 1) {
    Bytes inner(bytes.take_text(bytes.take<std::uint16_t>()));
    if (bytes.cut()) return fail(ErrorCode::Malformed, "bundle", "ends too early");
    const auto type = inner.take<std::uint32_t>();
    if (type == kBundle) return fail(ErrorCode::Malformed, "bundle", "is in a bundle");
    auto packet = packet_of(type, 0, inner);
    if (!packet) return pass(packet);
    out.push_back(std::move(*packet));
  }
  return out;
}

template <class Number>
void put(std::string& out, Number value) {
  std::uint64_t bits = 0;
  if constexpr (std::is_same_v<Number, float>)
    bits = std::bit_cast<std::uint32_t>(value);
  else
    bits = static_cast<std::uint64_t>(value);
  for (std::size_t i = sizeof(Number); i-- > 0;)
    out.push_back(static_cast<char>(bits >> (8 * i) & 0xff));
}

void put_vector(std::string& out, const Eigen::Vector3d& v) {
  for (Eigen::Index i = 0; i < 3; ++i) put(out, static_cast<float>(v(i)));
}

struct Encoder {
  std::string& out;

  void operator()(const Heartbeat&) const {}
  void operator()(const Handshake& h) const {
    for (const std::uint32_t each : {h.board, h.imu, h.mcu, 0u, 0u, 0u}) put(out, each);
    put(out, h.firmware_build);
    const std::string firmware = h.firmware.substr(0, 255);
    put(out, static_cast<std::uint8_t>(firmware.size()));
    out += firmware;
    for (const std::uint8_t each : h.mac) put(out, each);
  }
  void operator()(const Rotation& r) const {
    put(out, r.sensor);
    put(out, std::uint8_t{1});
    put_vector(out, r.world_from_tracker.vec());
    put(out, static_cast<float>(r.world_from_tracker.w()));
    put(out, std::uint8_t{0});
  }
  void operator()(const Acceleration& a) const {
    put_vector(out, a.in_tracker);
    put(out, a.sensor);
  }
  void operator()(const Battery& b) const {
    put(out, static_cast<float>(b.volts));
    put(out, static_cast<float>(b.charge));
  }
  void operator()(const SensorState& s) const {
    for (const std::uint8_t each : {s.sensor, s.status, s.type}) put(out, each);
  }
  void operator()(const MagnetometerAccuracy& m) const {
    put(out, m.sensor);
    put(out, static_cast<float>(m.radians));
  }
  void operator()(const Pong& p) const { put(out, p.id); }
  void operator()(const Other&) const {}
};

std::uint32_t type_of(const Content& content) {
  constexpr std::array<std::uint32_t, 8> kTypes{kHeartbeat,    kHandshake, kRotationData,
                                                kAcceleration, kBattery,   kSensor,
                                                kMagnetometer, kPong};
  const auto* const other = std::get_if<Other>(&content);
  return other != nullptr ? other->type : kTypes[content.index()];
}

}  // namespace

Result<std::vector<Packet>> parse(std::string_view datagram) {
  if (datagram.size() > kMaxDatagram) return fail(ErrorCode::TooLarge, "datagram", "is too long");
  Bytes bytes(datagram);
  const auto type = bytes.take<std::uint32_t>();
  const auto number = bytes.take<std::uint64_t>();
  if (bytes.cut()) return fail(ErrorCode::Malformed, "datagram", "is shorter than its head");
  if (type == kBundle) return unbundled(bytes);
  auto packet = packet_of(type, number, bytes);
  if (!packet) return pass(packet);
  return std::vector<Packet>{std::move(*packet)};
}

std::string encode(const Packet& packet) {
  std::string out;
  put(out, type_of(packet.content));
  put(out, packet.number);
  std::visit(Encoder{out}, packet.content);
  return out;
}

std::string encode_bundle(const std::vector<Packet>& packets) {
  std::string out;
  put(out, std::uint32_t{kBundle});
  put(out, std::uint64_t{0});
  for (const Packet& packet : packets) {
    std::string inner;
    put(inner, type_of(packet.content));
    std::visit(Encoder{inner}, packet.content);
    put(out, static_cast<std::uint16_t>(inner.size()));
    out += inner;
  }
  return out;
}

std::string handshake_answer() {
  std::string out(1, char{3});
  out += "Hey OVR =D 5";
  out.resize(kHandshakeAnswerBytes, '\0');
  return out;
}

std::string heartbeat() {
  std::string out;
  put(out, std::uint32_t{1});
  put(out, std::uint64_t{0});
  return out;
}

std::string ping(std::int32_t id) {
  std::string out;
  put(out, std::uint32_t{kPing});
  put(out, std::uint64_t{0});
  put(out, id);
  return out;
}

std::string sensor_answer(const SensorState& state) {
  std::string out;
  put(out, std::uint32_t{kSensor});
  put(out, state.sensor);
  put(out, state.status);
  return out;
}

}  // namespace chorus::inertial::slimevr
