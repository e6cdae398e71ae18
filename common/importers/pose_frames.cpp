#include "common/importers/pose_frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "common/importers/json_values.h"
#include "common/importers/picture_numbers.h"
#include "common/importers/pose_people.h"
#include "common/layout/tables.h"
#include "common/sensor/limits.h"
#include "common/sensor/pixel_ray.h"

namespace chorus::importers {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kMaxConfidence = 1e3;  // some networks exceed 1, which then counts as 1
constexpr std::uint64_t kMostId = 1'000'000'000;
// [s] after the first picture: 115 days.  A larger number is surely wrong, and could overflow a
// Timestamp.
constexpr double kLongest = 1e7;
/// Standard deviation of a landmark, relative to the height of the person: about 8 px at 500 px.
constexpr double kSigmaByHeight = 0.016;
constexpr double kLeastSigma = 2.0;  // [px]
// If this share of the landmarks is outside the picture, the size is wrong.
constexpr double kOutside = 0.2;

struct Count {
  std::size_t points;
  const layout::Layout* layout;
};
const std::array<Count, 6> kCounts{{{17, &layout::kCoco17},
                                    {18, &layout::kCoco18},
                                    {25, &layout::kBody25},
                                    {26, &layout::kHalpe26},
                                    {133, &layout::kCoco17},
                                    {136, &layout::kHalpe26}}};

using People = std::vector<PosePerson>;
/// People, by the number of the picture.
struct Pictures {
  double rate_hz = 30.0;
  std::map<std::uint64_t, People> people = {};

  /// Malformed: `number` is too large for the number of a picture.  Conflict: another picture has
  /// that number.
  [[nodiscard]] Result<void> add(std::uint64_t number, People&& found, const std::string& at) {
    if (!(static_cast<double>(number) <= kLongest * rate_hz))
      return fail(ErrorCode::Malformed, at,
                  fmt::format("is picture {}, which is more than {:g} s from the first.", number,
                              kLongest));
    if (people.try_emplace(number, std::move(found)).second) return {};
    return fail(ErrorCode::Conflict, at,
                fmt::format("is picture {}, and another one is that too; each picture of a camera "
                            "needs a number of its own, and each camera a folder.",
                            number));
  }
};

const layout::Layout* layout_of(const PosePerson& person) {
  const auto found = std::find_if(kCounts.begin(), kCounts.end(), [&](const Count& each) {
    return each.points == person.points.size();
  });
  return found == kCounts.end() ? nullptr : found->layout;
}

Result<PosePerson> checked(PosePerson person, const std::string& at) {
  if (layout_of(person) != nullptr) return person;
  return fail(ErrorCode::Unsupported, at,
              fmt::format("has {} landmarks; known are 17 (COCO), 18 (COCO of OpenPose), 25 "
                          "(BODY_25), 26 (HALPE), 133 and 136 (their whole bodies).",
                          person.points.size()));
}

double confidence_of(double value) { return std::clamp(value, 0.0, 1.0); }

/// A tracker's id plus 1.  The file has a number, or an array with one; none if it is negative or
/// absurdly large.
std::optional<std::uint64_t> id_in(const json& person) {
  for (const char* key : {"person_id", "track_id"}) {
    const auto found = person.find(key);
    if (found == person.end()) continue;
    const json& value = found->is_array() && found->size() == 1 ? (*found)[0] : *found;
    if (value.is_number_unsigned() && value.get<std::uint64_t>() < kMostId)
      return value.get<std::uint64_t>() + 1;  // ours begin at 1
  }
  return std::nullopt;
}

/// A landmark; not seen where a number is NaN.
PosePoint point_of(double u, double v, double confidence) {
  if (std::isnan(u + v + confidence)) return {{0.0, 0.0}, 0.0};
  return {{u, v}, confidence_of(confidence)};
}

Result<PosePerson> read_flat(const json& numbers, const std::string& at) {
  constexpr std::size_t kEach = 3;
  if (!numbers.is_array() || numbers.size() % kEach != 0)
    return fail(ErrorCode::Malformed, at, "must be u, v and confidence of each landmark.");
  std::vector<double> values(numbers.size());
  if (const auto read = read_numbers_or_null(numbers, values, kMaxPixel, at); !read)
    return pass(read);
  PosePerson person;
  for (std::size_t i = 0; i < values.size(); i += kEach)
    person.points.push_back(point_of(values[i], values[i + 1], values[i + 2]));
  return checked(std::move(person), at);
}

Result<PosePerson> read_pairs(const json& instance, const std::string& at) {
  const auto points = member(instance, "keypoints", at);
  if (!points) return pass(points);
  const auto scores = member(instance, "keypoint_scores", at);
  if (!scores) return pass(scores);
  if (!(*points)->is_array())
    return fail(ErrorCode::Malformed, at, "\"keypoints\" must be an array.");
  std::vector<double> confidence((*points)->size());
  if (const auto read =
          read_numbers_or_null(**scores, confidence, kMaxConfidence, at + ".keypoint_scores");
      !read)
    return pass(read);
  PosePerson person;
  for (std::size_t i = 0; i < confidence.size(); ++i) {
    std::array<double, 2> pixel{};
    const auto read = read_numbers_or_null((**points)[i], pixel, kMaxPixel, at + ".keypoints");
    if (!read) return pass(read);
    person.points.push_back(point_of(pixel[0], pixel[1], confidence[i]));
  }
  return checked(std::move(person), at);
}

Result<PosePerson> read_person(const json& person, const std::string& at) {
  if (!person.is_object()) return fail(ErrorCode::Malformed, at, "must be an object.");
  const auto flat = person.find("pose_keypoints_2d");
  auto read =
      flat != person.end() ? read_flat(*flat, at + ".pose_keypoints_2d") : read_pairs(person, at);
  if (read) read->id = id_in(person);
  return read;
}

Result<People> read_people(const json& list, const std::string& at) {
  if (!list.is_array()) return fail(ErrorCode::Malformed, at, "must be an array of people.");
  People people;
  for (std::size_t i = 0; i < list.size() && people.size() < kMaxBodies; ++i) {
    auto person = read_person(list[i], fmt::format("{}[{}]", at, i));
    if (!person) return pass(person);
    people.push_back(std::move(*person));
  }
  return people;
}

/// The list of pictures in a video's file; none if the document describes a single picture.
const json* pictures_in(const json& document) {
  const json* list = &document;
  if (document.is_object()) {
    const auto found = document.find("instance_info");
    if (found == document.end()) return nullptr;
    list = &*found;
  }
  const bool numbered = list->is_array() && !list->empty() && list->front().is_object() &&
                        list->front().contains("instances");
  return numbered ? list : nullptr;
}

Result<void> read_video(const json& list, const std::string& at, Pictures& out) {
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string here = fmt::format("{}: [{}]", at, i);
    const auto instances = member(list[i], "instances", here);
    if (!instances) return pass(instances);
    auto people = read_people(**instances, here + ".instances");
    if (!people) return pass(people);
    const auto number = list[i].find("frame_id");
    const bool numbered = number != list[i].end() && number->is_number_unsigned();
    const auto added =
        out.add(numbered ? number->get<std::uint64_t>() : i, std::move(*people), here);
    if (!added) return pass(added);
  }
  return {};
}

/// `number` is that of the picture, for a file that describes a single one.
Result<void> read_document(const fs::path& file, std::uint64_t number, const ImportLimits& limits,
                           Pictures& out) {
  const std::string at = file.string();
  const auto document = read_json(file, limits.max_json_bytes, Nan::IsNull);
  if (!document) return pass(document);
  if (const json* pictures = pictures_in(*document)) return read_video(*pictures, at, out);
  const json* people = &*document;
  if (document->is_object()) {
    const auto listed = member(*document, "people", at);
    if (!listed) return pass(listed);
    people = *listed;
  }
  auto read = read_people(*people, at + ": people");
  if (!read) return pass(read);
  return out.add(number, std::move(*read), at);
}

struct Damage {
  std::size_t files = 0;
  std::string first;
};

Result<Pictures> read_pictures(const fs::path& input, double rate_hz, const ImportLimits& limits,
                               Damage& damage) {
  Pictures pictures{rate_hz};
  std::error_code failed;
  if (!fs::is_directory(input, failed)) {
    if (auto read = read_document(input, 0, limits, pictures); !read) return pass(read);
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
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto read = read_document(files[i], numbers[i], limits, pictures);
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
  add_frames(*pictures, camera, options, recording);
  return recording;
}

}  // namespace chorus::importers
