// Writes the lean form of a frame, ?form=pose: for each joint its place and state, and nothing that
// says how they came about.  The keys are those of the full frame in JSON, so its readers read it.
#include <fmt/format.h>

#include <iterator>

#include "common/body/bones.h"
#include "common/resource/frame_parts.h"
#include "common/resource/frame_resource.h"

namespace chorus::resource {
namespace {

/// Millimetres, and 1e-4 of a ray's direction.
void put_place(std::string& out, const JointResource& joint) {
  const Eigen::Vector3d& p = joint.position;
  if (joint.measurement == Measurement::Point) {
    fmt::format_to(std::back_inserter(out), R"("x":{:.3f},"y":{:.3f},"z":{:.3f},)", p.x(), p.y(),
                   p.z());
  } else {
    fmt::format_to(std::back_inserter(out), R"("rayX":{:.4f},"rayY":{:.4f},"rayZ":{:.4f},)", p.x(),
                   p.y(), p.z());
  }
}

void put_body(std::string& out, const BodyResource& body) {
  const auto to = std::back_inserter(out);
  // Integers that readers of JSON might round are strings, as in the full frame.
  const char* quote = body.id > (std::uint64_t{1} << 53) - 1 ? "\"" : "";
  fmt::format_to(to, R"({{"bodyId":{}{}{})", quote, body.id, quote);
  if (body.slot) fmt::format_to(to, R"(,"slot":{})", *body.slot);
  if (body.sides_confidence)
    fmt::format_to(to, R"(,"sidesConfidence":{:.2f})", *body.sides_confidence);
  if (body.carried_for) fmt::format_to(to, R"(,"carriedFor":{:.2f})", *body.carried_for);
  std::string_view before = R"(,"joints":{)";
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const JointState state = writable_state(body.joints[i]);
    fmt::format_to(to, R"({}"{}":{{)", before, kJointNames[i]);
    if (state != JointState::NotTracked) put_place(out, body.joints[i]);
    fmt::format_to(to, R"("state":"{}"}})", name_of(state));
    before = ",";
  }
  out += "}}";
}

}  // namespace

std::string write_pose(const FrameResource& frame) {
  std::string out;
  const char* quote = frame.sequence > (std::uint64_t{1} << 53) - 1 ? "\"" : "";
  fmt::format_to(std::back_inserter(out),
                 R"({{"@type":"Frame","sequence":{0}{1}{0},"captured":"{2}",)"
                 R"("capturedNanoseconds":"{3}","source":{4},"space":"{5}")",
                 quote, frame.sequence, to_iso8601(frame.captured), to_unix_ns(frame.captured),
                 in_quotes(frame.source), name_of(frame.space));
  if (frame.registration_version)
    fmt::format_to(std::back_inserter(out), R"(,"registrationVersion":{})",
                   *frame.registration_version);
  out += ",\"bodies\":[";
  for (const BodyResource& body : frame.bodies) {
    if (out.back() == '}') out += ',';
    put_body(out, body);
  }
  return out + "]}\n";
}

}  // namespace chorus::resource
