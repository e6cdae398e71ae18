#include "services/ctl/convert/fused_samples.h"

#include <utility>

#include "services/ctl/convert/fused_frames.h"

namespace chorus::ctl {
namespace {

constexpr std::size_t kMaxSamples = exporters::kMaxPoses;

void add_body(FusedSamples& samples, const resource::BodyResource& body, Timestamp instant) {
  exporters::FusedSample sample{instant, PersonId{body.id}, {}};
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const resource::JointResource& joint = body.joints[j];
    sample.skeleton.joints[j] = {joint.position, joint.orientation, joint.state};
    if (joint.variance) sample.variance[j] = *joint.variance;
  }
  samples.push_back(sample);
}

Result<void> add_frame(FusedSamples& samples, const resource::FrameResource& frame,
                       const std::string& at) {
  if (samples.size() + frame.bodies.size() > kMaxSamples)
    return fail(ErrorCode::TooLarge, at, "is beyond the 500000 poses read at most.");
  for (const auto& body : frame.bodies) add_body(samples, body, frame.captured);
  return {};
}

record::TakeFrame into(FusedSamples& samples) {
  return [&samples](const resource::FrameResource& frame, const std::string& at) {
    return add_frame(samples, frame, at);
  };
}

}  // namespace

Result<FusedSamples> read_fused_lines(std::istream& lines, const std::string& origin) {
  FusedSamples samples;
  const auto read = record::each_fused_line(lines, origin, into(samples));
  if (!read) return pass(read);
  return samples;
}

Result<FusedFrames> read_fused_frames(const std::string& source, std::chrono::milliseconds listen) {
  FusedFrames out;
  auto notes = each_fused_frame(source, listen, into(out.samples));
  if (!notes) return pass(notes);
  out.notes = std::move(*notes);
  return out;
}

}  // namespace chorus::ctl
