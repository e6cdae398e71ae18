// Reads back the bytes that frame_turtle.cpp writes, following its template; 25 times faster than a
// parser.
//
// Nothing is decided here: at the first byte that is not as expected, or value that is not plainly
// right, the answer is nullopt and the parser reads the document from the start, with its messages.
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "common/body/bones.h"
#include "common/resource/contributors.h"
#include "common/resource/frame_facts.h"

namespace chorus::resource {
namespace {

constexpr std::string_view kHead =
    "@prefix ch: <https://w3id.org/chorus-tracking/ns#> .\n"
    "@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .\n\n<";
constexpr std::size_t kIsoLength = 30;  // 2026-11-21T07:30:00.250000000Z
constexpr std::size_t kMaxNames = 160;  // longest folder of the names in a document
constexpr int kMaxDigits = 15;          // exact in a double
constexpr std::array kPowersOfTen{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                  1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

/// Each step returns false at a surprise; callers give up.
class Template {
 public:
  explicit Template(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

  std::optional<FrameResource> run() {
    if (!head() || !body_links()) return std::nullopt;
    for (BodyResource& body : frame_.bodies) {
      if (!this->body(body)) return std::nullopt;
    }
    if (at_ != end_) return std::nullopt;
    return std::move(frame_);
  }

 private:
  bool text(std::string_view expected) {
    if (static_cast<std::size_t>(end_ - at_) < expected.size()) return false;
    if (std::memcmp(at_, expected.data(), expected.size()) != 0) return false;
    at_ += expected.size();
    return true;
  }

  template <class Integer>
  bool integer(Integer& out) {
    const auto [next, code] = std::from_chars(at_, end_, out);
    if (code != std::errc{} || out < 0) return false;
    at_ = next;
    return true;
  }

  bool decimal(double& out) {
    const bool negative = at_ < end_ && *at_ == '-';
    if (negative) ++at_;
    std::int64_t digits = 0;
    int count = 0;
    const char* point = nullptr;
    for (; at_ < end_; ++at_) {
      if (*at_ == '.' && point == nullptr) {
        point = at_;
      } else if (*at_ >= '0' && *at_ <= '9') {
        digits = digits * 10 + (*at_ - '0');
        if (++count > kMaxDigits) return false;
      } else {
        break;
      }
    }
    if (point == nullptr || at_ - point < 2 || count == at_ - point - 1) return false;
    const double value =
        static_cast<double>(digits) / kPowersOfTen[static_cast<std::size_t>(at_ - point - 1)];
    out = negative ? -value : value;
    return value <= kMaxCoordinate;
  }

  /// A quoted name of [A-Za-z0-9_-].
  bool name(std::string_view& out) {
    if (!text("\"")) return false;
    const char* const begin = at_;
    while (at_ < end_ && plain(*at_)) ++at_;
    out = {begin, static_cast<std::size_t>(at_ - begin)};
    return text("\"") && SensorId::parse(out).has_value();
  }

  bool times(Timestamp& out) {
    if (!text(" ;\n  ch:captured \"") || static_cast<std::size_t>(end_ - at_) < kIsoLength)
      return false;
    const std::string_view iso(at_, kIsoLength);
    at_ += kIsoLength;
    std::int64_t ns = 0;
    if (!text("\"^^xsd:dateTime ;\n  ch:capturedNanoseconds ") || !integer(ns)) return false;
    out = from_unix_ns(ns);
    if (iso == iso_ && out == iso_time_) return true;
    const auto parsed = parse_iso8601(iso);
    if (!parsed || *parsed != out) return false;
    iso_ = iso;
    iso_time_ = out;
    return true;
  }

  bool head() {
    if (!text(kHead)) return false;
    const std::string_view rest(at_, static_cast<std::size_t>(end_ - at_));
    const std::size_t close = rest.substr(0, kMaxNames).find("frame>");
    if (close == std::string_view::npos) return false;
    names_ = rest.substr(0, close);
    for (const char c : names_) {
      if (!plain(c) && c != '.' && c != '/') return false;
    }
    at_ += close;
    if (!text("frame> a ch:Frame ;\n  ch:sequence ") || !integer(frame_.sequence)) return false;
    std::string_view source;
    if (!times(frame_.captured) || !text(" ;\n  ch:source ") || !name(source)) return false;
    frame_.source = source;
    if (!text(" ;\n  ch:space ch:")) return false;
    if (text("WorldSpace")) {
      frame_.space = SpaceKind::World;
    } else if (!text("SensorSpace")) {
      return false;
    }
    return !text(" ;\n  ch:sensor ") || sensors();
  }

  bool sensors() {
    do {
      std::string_view sensor;
      if (!name(sensor) || frame_.sensors.size() == kMaxSensors) return false;
      for (const std::string& other : frame_.sensors) {
        if (other == sensor) return false;
      }
      frame_.sensors.emplace_back(sensor);
    } while (text(", "));
    return true;
  }

  bool body_name(std::uint64_t id) {
    std::array<char, 20> digits{};
    const char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), id).ptr;
    return text(names_) && text("skeletons/") &&
           text({digits.data(), static_cast<std::size_t>(end - digits.data())});
  }

  bool body_links() {
    if (text(" .\n")) return true;
    if (!text(" ;\n  ch:body ")) return false;
    do {
      std::uint64_t id = 0;
      if (!text("<") || !text(names_) || !text("skeletons/") || !integer(id) || !text(">"))
        return false;
      for (const BodyResource& other : frame_.bodies) {
        if (other.id == id) return false;
      }
      if (frame_.bodies.size() == kMaxBodies) return false;
      frame_.bodies.emplace_back().id = id;
    } while (text(", "));
    return text(" .\n");
  }

  bool body(BodyResource& body) {
    const char* const begin = at_ + 2;
    std::uint64_t id = 0;
    if (!text("\n<") || !body_name(body.id)) return false;
    const std::string_view iri(begin, static_cast<std::size_t>(at_ - begin));
    if (!text("> a ch:Skeleton ;\n  ch:bodyId ") || !integer(id) || id != body.id) return false;
    if (!times(body.captured) || !text(" ;\n  ch:joint ")) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text(i == 0 ? "<" : ", <") || !text(iri) || !text("#") || !text(kJointNames[i]) ||
          !text(">")) {
        return false;
      }
    }
    if (!text(" .\n")) return false;
    for (std::size_t i = 0; i < kJointCount; ++i) {
      if (!text("\n<") || !text(iri) || !text("#") || !text(kJointNames[i])) return false;
      if (!text("> a ch:Joint ;\n  ch:jointName \"") || !text(kJointNames[i]) ||
          !text("\" ;\n  ch:"))
        return false;
      if (!joint(body.joints[i]) || !text(" .\n")) return false;
    }
    return true;
  }

  /// From behind "ch:" of the first property to before the final " .".
  bool joint(JointResource& joint) {
    if (text("state ch:NotTracked")) return true;
    auto& p = joint.position;
    if (!text("x ") || !decimal(p.x()) || !text(" ; ch:y ") || !decimal(p.y()) ||
        !text(" ; ch:z ") || !decimal(p.z()) || !text(" ;\n  ch:")) {
      return false;
    }
    if (text("qx ") && !orientation(joint.orientation)) return false;
    if (!text("state ch:")) return false;
    joint.state = text("Tracked") ? JointState::Tracked : JointState::Inferred;
    if (joint.state == JointState::Inferred && !text("Inferred")) return false;
    if (text(" ;\n  ch:variance ")) {
      double variance = 0.0;
      if (!decimal(variance) || variance < 0.0) return false;
      joint.variance = variance;
    }
    return !text(" ;\n  ch:contributor ") || contributors(joint.contributors);
  }

  bool orientation(Eigen::Quaterniond& q) {
    if (!decimal(q.x()) || !text(" ; ch:qy ") || !decimal(q.y()) || !text(" ; ch:qz ") ||
        !decimal(q.z()) || !text(" ; ch:qw ") || !decimal(q.w()) || !text(" ;\n  ch:")) {
      return false;
    }
    return std::abs(q.norm() - 1.0) <= kUnitTolerance;
  }

  bool contributors(std::uint64_t& bits) {
    do {
      std::size_t i = 0;
      if (!text("\"")) return false;
      while (i < frame_.sensors.size() && !closes(frame_.sensors[i])) ++i;
      if (i == frame_.sensors.size()) return false;
      at_ += frame_.sensors[i].size() + 1;
      bits |= std::uint64_t{1} << i;
    } while (text(", "));
    return true;
  }

  [[nodiscard]] bool closes(const std::string& sensor) const {
    const std::string_view rest(at_, static_cast<std::size_t>(end_ - at_));
    return rest.starts_with(sensor) && rest.substr(sensor.size()).starts_with('"');
  }

  const char* at_;
  const char* const end_;
  std::string_view names_;
  std::string_view iso_;
  Timestamp iso_time_;
  FrameResource frame_;
};

}  // namespace

std::optional<FrameResource> read_template(std::string_view turtle) {
  return Template(turtle).run();
}

Result<FrameResource> read_frame(std::string_view bytes, Format format) {
  if (format == Format::Json || format == Format::JsonLd) return read_json_frame(bytes);
  constexpr std::size_t kMaxBytes =
      2'000'000;  // the parser's limit holds here too (proto/README.md)
  if (format == Format::Turtle && bytes.size() <= kMaxBytes) {
    if (auto frame = read_template(bytes)) return *std::move(frame);
  }
  return read_rdf_frame(bytes, format);
}

}  // namespace chorus::resource
