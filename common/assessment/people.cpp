#include "common/assessment/people.h"

#include <fmt/format.h>

namespace chorus::assessment {
namespace {

double seconds_between(Timestamp from, Timestamp to) {
  return std::chrono::duration<double>(to - from).count();
}

}  // namespace

ergonomics::BodyAt body_at(const resource::BodyResource& body, Timestamp captured) {
  ergonomics::BodyAt out;
  out.at = captured;
  out.sides_confidence = body.sides_confidence.value_or(1.0);
  out.carried = body.carried_for.has_value();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const resource::JointResource& joint = body.joints[j];
    Joint& to = out.body.joints[j];
    to = joint;
    if (!to.covariance.known() && joint.variance)
      to.covariance = Covariance(Eigen::Matrix3d::Identity() * *joint.variance);
  }
  return out;
}

Result<void> People::add(const resource::FrameResource& frame) {
  if (start_ && frame.captured == last_) return {};
  if (start_ && frame.captured < last_)
    return fail(ErrorCode::Malformed, to_iso8601(frame.captured), "comes after a later frame");
  if (!start_) start_ = frame.captured;
  last_ = frame.captured;
  ++frames_;
  for (const resource::BodyResource& body : frame.bodies)
    bodies_[body.id].push_back(body_at(body, frame.captured));
  return {};
}

double People::seconds() const { return start_ ? seconds_between(*start_, last_) : 0.0; }

Result<std::optional<posture::Neutral>> stance_of(const std::vector<ergonomics::BodyAt>& bodies,
                                                  const std::optional<ergonomics::Span>& stretch,
                                                  Timestamp start) {
  if (!stretch) return ergonomics::stance_in(bodies);
  std::vector<posture::Instant> instants;
  for (const ergonomics::BodyAt& body : bodies) {
    if (!body.carried && stretch->holds(seconds_between(start, body.at)))
      instants.push_back({body.at, posture::posture_of(body.body).measures});
  }
  auto neutral = posture::neutral_of(instants);
  if (!neutral)
    return fail(neutral.error().code,
                fmt::format("stance from {:g} to {:g} s", stretch->from, stretch->to),
                to_string(neutral.error()));
  return std::optional<posture::Neutral>(std::move(*neutral));
}

}  // namespace chorus::assessment
