#include "common/importers/datasets/nw_ucla_json.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/importers/uniform_clock.h"

namespace chorus::importers {
namespace {

/// Our names for the joints of Kinect v1, in the order of SDK 1; what it calls ShoulderCenter is
/// our SpineShoulder.
// clang-format off
constexpr std::array kOurJoint{
    JointId::SpineBase, JointId::SpineMid, JointId::SpineShoulder, JointId::Head,
    JointId::ShoulderLeft, JointId::ElbowLeft, JointId::WristLeft, JointId::HandLeft,
    JointId::ShoulderRight, JointId::ElbowRight, JointId::WristRight, JointId::HandRight,
    JointId::HipLeft, JointId::KneeLeft, JointId::AnkleLeft, JointId::FootLeft,
    JointId::HipRight, JointId::KneeRight, JointId::AnkleRight, JointId::FootRight};
// clang-format on

Result<Skeleton<SensorSpace>> read_skeleton(const nlohmann::json& joints, const std::string& at) {
  if (!joints.is_array() || joints.size() != kOurJoint.size())
    return fail(ErrorCode::Malformed, at,
                fmt::format("must hold the {} joints of a Kinect v1.", kOurJoint.size()));
  Skeleton<SensorSpace> skeleton;
  for (std::size_t j = 0; j < kOurJoint.size(); ++j) {
    std::array<double, 3> x{};
    const auto read = read_numbers(joints[j], x, kMaxImported, fmt::format("{}[{}]", at, j));
    if (!read) return pass(read);
    Joint& joint = skeleton[kOurJoint[j]];
    joint.position = {x[0], x[1], x[2]};
    joint.state = JointState::Tracked;
  }
  return skeleton;
}

Result<void> read_skeletons(const nlohmann::json& skeletons, const std::string& at,
                            const ImportOptions& options, record::FrameRecording& recording) {
  if (!skeletons.is_array() || skeletons.empty())
    return fail(ErrorCode::Malformed, at, "\"skeletons\" must be an array of frames.");
  if (skeletons.size() > options.limits.max_frames)
    return fail(ErrorCode::TooLarge, at,
                fmt::format("holds {} frames; at most {} are read.", skeletons.size(),
                            options.limits.max_frames));
  for (std::size_t i = 0; i < skeletons.size(); ++i) {
    const auto skeleton = read_skeleton(skeletons[i], fmt::format("{}: skeletons[{}]", at, i));
    if (!skeleton) return pass(skeleton);
    const Timestamp captured = uniform_instant(options.start, i, kKinectHz);
    recording.frames.push_back({recording.sensor,
                                i + 1,
                                captured,
                                captured,
                                {{kOnlyBody, captured, *skeleton}},
                                options.floor});
  }
  return {};
}

/// The sensor's name: a01_s01_e00_v02.json -> v02; any other name stays as it is.
Result<SensorId> view_of(const std::filesystem::path& file, const ImportOptions& options) {
  if (options.sensor) return *options.sensor;
  const std::string stem = file.stem().string();
  const auto cut = stem.rfind("_v");
  return sensor_named_after(cut == std::string::npos ? stem : stem.substr(cut + 1));
}

bool same_positions(const record::FrameRecording& a, const record::FrameRecording& b) {
  if (a.frames.size() != b.frames.size()) return false;
  const auto same_body = [](const BodyFrame& left, const BodyFrame& right) {
    return std::equal(left.skeleton.joints.begin(), left.skeleton.joints.end(),
                      right.skeleton.joints.begin(),
                      [](const Joint& x, const Joint& y) { return x.position == y.position; });
  };
  return std::equal(a.frames.begin(), a.frames.end(), b.frames.begin(),
                    [&](const SensorFrame& left, const SensorFrame& right) {
                      return std::equal(left.bodies.begin(), left.bodies.end(),
                                        right.bodies.begin(), right.bodies.end(), same_body);
                    });
}

}  // namespace

Result<record::FrameRecording> read_nw_ucla_json(const std::filesystem::path& file,
                                                 const ImportOptions& options) {
  const auto document = read_json(file, options.limits.max_json_bytes);
  if (!document) return pass(document);
  const auto skeletons = member(*document, "skeletons", file.string());
  if (!skeletons) return pass(skeletons);
  const auto sensor = view_of(file, options);
  if (!sensor) return pass(sensor);
  record::FrameRecording recording;
  recording.sensor = *sensor;
  recording.device = "Kinect v1 (NW-UCLA json)";
  recording.floor = options.floor;
  recording.notes = {{"origin", file.filename().string()},
                     {"time", kUniformTimeNote},
                     {"states",
                      "none in the file; the 20 joints of a Kinect v1 count as tracked, "
                      "Neck, hand tips and thumbs as not tracked"}};
  if (const auto read = read_skeletons(**skeletons, file.string(), options, recording); !read)
    return pass(read);
  return recording;
}

Result<void> refuse_copies(const std::vector<record::FrameRecording>& views) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t k = i + 1; k < views.size(); ++k) {
      if (same_positions(views[i], views[k]))
        return fail(
            ErrorCode::InvalidArgument, views[k].sensor.str(),
            fmt::format("holds the very numbers of {}: the dataset contains one view twice. "
                        "Leave one of the two files out.",
                        views[i].sensor.str()));
    }
  }
  return {};
}

}  // namespace chorus::importers
