#include "common/importers/pose_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/importers/picture_numbers.h"
#include "common/importers/pose_document.h"
#include "common/importers/pose_people.h"
#include "common/sensor/pixel_ray.h"

namespace chorus::importers {
namespace {

namespace fs = std::filesystem;

/// Standard deviation of a landmark, relative to the height of the person: about 8 px at 500 px.
constexpr double kSigmaByHeight = 0.016;
constexpr double kLeastSigma = 2.0;  // [px]
// If this share of the landmarks is outside the picture, the size is wrong.
constexpr double kOutside = 0.2;

struct Damage {
  std::size_t files = 0;
  std::string first;
};

Result<Pictures> read_pictures(const fs::path& input, double rate_hz, const ImportLimits& limits,
                               Damage& damage) {
  Pictures pictures{rate_hz};
  std::error_code failed;
  if (!fs::is_directory(input, failed)) {
    if (auto read = read_pose_document(input, 0, limits, pictures); !read) return pass(read);
    return pictures;
  }
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(input, failed)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
    if (files.size() > limits.max_frames)
      return fail(ErrorCode::TooLarge, input.string(), "holds too many files.");
  }
  std::sort(files.begin(), files.end());
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(file.stem().string());
  const auto numbers = picture_numbers(names);
  pictures.by_order = numbers.by_order;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto read = read_pose_document(files[i], numbers.numbers[i], limits, pictures);
    if (read) continue;
    if (read.error().code == ErrorCode::Conflict) return pass(read);
    if (damage.files++ == 0) damage.first = to_string(read.error());
  }
  if (!pictures.people.empty()) return pictures;
  return fail(ErrorCode::NotFound, input.string(),
              damage.files == 0 ? "holds no .json files; name the folder of one camera."
                                : "holds no file that can be used; the first: " + damage.first);
}

/// Refuses landmarks that do not fit the picture size of `camera`.
Result<void> check_size(const Pictures& pictures, const Intrinsics& camera, const std::string& at) {
  std::size_t sure = 0;
  std::size_t outside = 0;
  double farthest = 0.0;
  for (const auto& [number, people] : pictures.people) {
    for (const PosePerson& person : people) {
      for (const PosePoint& point : person.points) {
        if (point.confidence < 0.3) continue;
        ++sure;
        const auto& [u, v] = std::pair(point.pixel.x(), point.pixel.y());
        outside += u < 0 || v < 0 || u > camera.width || v > camera.height ? 1 : 0;
        farthest = std::max({farthest, u, v});
      }
    }
  }
  if (sure > 0 && farthest <= 2.0)
    return fail(
        ErrorCode::InvalidArgument, at,
        "has landmarks from 0 to 1 instead of pixels; run OpenPose with --keypoint_scale 0.");
  if (static_cast<double>(outside) <= kOutside * static_cast<double>(sure)) return {};
  return fail(ErrorCode::InvalidArgument, at,
              fmt::format("has landmarks outside of pictures of {} x {}; are these the intrinsics "
                          "of this camera, for pictures of this size?",
                          camera.width, camera.height));
}

double height_of(const PosePerson& person) {
  double top = kMaxPixel;
  double bottom = -kMaxPixel;
  for (const PosePoint& point : person.points) {
    if (point.confidence < 0.1) continue;
    top = std::min(top, point.pixel.y());
    bottom = std::max(bottom, point.pixel.y());
  }
  return std::max(0.0, bottom - top);
}

layout::Landmark ray_through(const PosePoint& point, const layout::Layout& layout,
                             const Intrinsics& camera, double sigma) {
  const auto ray = ray_of(point.pixel, camera);
  if (!ray || point.confidence <= 0.0) return {};
  const Eigen::Matrix3d sensor_from_image = Eigen::Vector3d(-1.0, -1.0, 1.0).asDiagonal();
  return {sensor_from_image * *ray,
          layout::state_of(point.confidence, layout.tracked_from, layout.inferred_from),
          Measurement::Ray,
          Covariance(ray_covariance(*ray, camera, sigma)).turned(sensor_from_image)};
}

std::optional<BodyFrame> body_of(const PosePerson& person, std::uint64_t number,
                                 const Intrinsics& camera, Timestamp captured) {
  const layout::Layout& layout = *layout_of(person);
  const double sigma = std::max(kLeastSigma, kSigmaByHeight * height_of(person));
  std::vector<layout::Landmark> landmarks;
  for (std::size_t i = 0; i < layout.landmarks.size(); ++i)
    landmarks.push_back(ray_through(person.points[i], layout, camera, sigma));
  BodyFrame body{BodyId{number}, captured, {layout::joints_of(layout, landmarks)}};
  const auto& joints = body.skeleton.joints;
  if (std::none_of(joints.begin(), joints.end(), [](const Joint& j) { return j.given(); }))
    return std::nullopt;
  return body;
}

SensorFrame frame_of(const People& people, const std::vector<std::uint64_t>& numbers,
                     const Intrinsics& camera, Timestamp captured) {
  SensorFrame frame;
  frame.captured = frame.received = captured;
  for (std::size_t i = 0; i < people.size(); ++i) {
    if (auto body = body_of(people[i], numbers[i], camera, captured))
      frame.bodies.push_back(std::move(*body));
  }
  return frame;
}

std::string layout_name(const Pictures& pictures) {
  for (const auto& [number, people] : pictures.people) {
    if (!people.empty()) return std::string(layout_of(people.front())->name);
  }
  return "unknown: nobody was found";
}

record::FrameRecording header_of(const fs::path& input, const PoseCamera& camera,
                                 const ImportOptions& options) {
  record::FrameRecording recording;
  recording.device = "camera with landmarks of a pose estimator";
  recording.intrinsics = camera.intrinsics;
  recording.floor = options.floor;
  recording.notes = {{"origin", input.filename().string()},
                     {"time", fmt::format("numbers of pictures by {:g} a second, from {}",
                                          camera.rate_hz, to_iso8601(options.start))},
                     {"space", "rays of the landmarks' pixels; no depth"}};
  return recording;
}

void note_people(const Pictures& pictures, record::FrameRecording& out) {
  if (pictures.by_order)
    out.notes["damage.3"] =
        "the last numbers in the names go back, as those of a time of day do, and are no numbers "
        "of "
        "pictures: the pictures are taken in the order of the names, at --rate, without gaps";
  if (pictures.unreadable > 0)
    out.notes["damage.2"] =
        fmt::format("{} people could not be read and were left out; the first: {}",
                    pictures.unreadable, pictures.first_unreadable);
  if (pictures.without_landmarks > 0)
    out.notes["absent"] =
        fmt::format("{} people without landmarks were skipped", pictures.without_landmarks);
  if (pictures.at_origin > 0)
    out.notes["unseen"] =
        fmt::format("{} landmarks at the pixel 0, 0 are taken as not seen", pictures.at_origin);
}

void add_frames(const Pictures& pictures, const PoseCamera& camera, const ImportOptions& options,
                record::FrameRecording& out) {
  PeopleNumbers numbers;
  for (const auto& [number, people] : pictures.people) {
    const Timestamp captured =
        options.start + from_seconds(static_cast<double>(number) / camera.rate_hz);
    SensorFrame frame = frame_of(people, numbers.number(people), camera.intrinsics, captured);
    frame.sensor = out.sensor;
    frame.sequence = out.frames.size() + 1;
    frame.floor = options.floor;
    out.frames.push_back(std::move(frame));
  }
}

}  // namespace

Result<record::FrameRecording> read_pose_frames(const fs::path& input, const PoseCamera& camera,
                                                const ImportOptions& options) {
  const auto sensor = sensor_for(input, options);
  if (!sensor) return pass(sensor);
  Damage damage;
  const auto pictures = read_pictures(input, camera.rate_hz, options.limits, damage);
  if (!pictures) return pass(pictures);
  if (const auto ok = check_size(*pictures, camera.intrinsics, input.string()); !ok)
    return pass(ok);
  record::FrameRecording recording = header_of(input, camera, options);
  recording.sensor = *sensor;
  recording.notes["layout"] = layout_name(*pictures);
  if (damage.files > 0)
    recording.notes["damage.1"] =
        fmt::format("{} files have no frame; the first: {}", damage.files, damage.first);
  note_people(*pictures, recording);
  add_frames(*pictures, camera, options, recording);
  return recording;
}

}  // namespace chorus::importers
