#include "services/ctl/position/position_inputs.h"

#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/positioning/body_size.h"
#include "common/record/frame_recording.h"
#include "fusion-server/server/registration_store.h"
#include "services/ctl/calibrate/lens_file.h"
#include "services/ctl/convert/video_import.h"
#include "services/ctl/convert/video_sights.h"
#include "services/ctl/evaluate/compared_source.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using positioning::CameraTake;
using positioning::Method;

bool is_suit(const fs::path& file) {
  const auto format = motion_format(file.string());
  using importers::MotionFormat;
  return format == MotionFormat::Bvh || format == MotionFormat::Htr || format == MotionFormat::Mvnx;
}

/// What one input gives before its place is known.
struct Looked {
  record::FrameRecording recording;
  std::optional<camera::CameraSettings> video;  ///< None: a recording.
  std::shared_ptr<PersonMasks> masks;           ///< Null: the runner gives none.
};

Result<camera::CameraSettings> film_settings(const PositionInputs& inputs,
                                             const PositionArguments& arguments,
                                             std::size_t index) {
  const std::size_t lens = arguments.lenses.size() == 1 ? 0 : index;
  auto settings = read_lens_file(arguments.lenses.at(lens));
  if (!settings) return pass(settings);
  settings->source = inputs.videos[index].string();
  settings->loop = false;
  settings->max_rate_hz = arguments.rate_hz;
  return settings;
}

Result<void> check_lenses(const PositionInputs& inputs, const PositionArguments& arguments) {
  if (inputs.videos.empty()) return {};
  if (arguments.lenses.empty())
    return fail(ErrorCode::InvalidArgument, "--intrinsics",
                "is missing: the camera's lens, as `chorus calibrate camera` writes it");
  return check_lens_count(arguments.lenses, inputs.videos.size());
}

/// The videos, with the people that the runner finds in them.
Result<std::vector<Looked>> looked_through(const PositionInputs& inputs,
                                           const PositionArguments& arguments) {
  std::map<SensorId, std::shared_ptr<PersonMasks>> masks;
  VideoImport how{arguments.lenses, arguments.model, arguments.rate_hz};
  const bool wanted = arguments.method == "both" &&
                      (arguments.background == "auto" || arguments.background == "network");
  if (wanted)
    how.mask = [&](const SensorId& sensor, Timestamp captured, camera::PersonMask mask) {
      auto& own = masks[sensor];
      if (!own) own = std::make_shared<PersonMasks>();
      own->emplace(captured, std::move(mask));
    };
  auto set = import_videos(inputs.videos, {}, how);
  if (!set) return pass(set);
  std::vector<Looked> out;
  for (std::size_t i = 0; i < set->recordings.size(); ++i) {
    record::FrameRecording& recording = set->recordings[i];
    auto settings = film_settings(inputs, arguments, i);
    if (!settings) return pass(settings);
    const auto own = masks.find(recording.sensor);
    out.push_back(
        {std::move(recording), std::move(*settings), own == masks.end() ? nullptr : own->second});
  }
  return out;
}

/// The videos without a runner: only their times.
Result<std::vector<Looked>> timed(const PositionInputs& inputs,
                                  const PositionArguments& arguments) {
  std::vector<Looked> out;
  for (std::size_t i = 0; i < inputs.videos.size(); ++i) {
    auto settings = film_settings(inputs, arguments, i);
    if (!settings) return pass(settings);
    const auto sensor = importers::sensor_for(inputs.videos[i], {});
    if (!sensor) return pass(sensor);
    auto frames = empty_frames(*settings, *sensor, importers::kDefaultStart);
    if (!frames) return pass(frames);
    Looked one;
    one.recording.sensor = *sensor;
    one.recording.frames = std::move(*frames);
    one.video = std::move(*settings);
    out.push_back(std::move(one));
  }
  return out;
}

Result<std::vector<Looked>> all_looked(const PositionInputs& inputs,
                                       const PositionArguments& arguments, Method method) {
  std::vector<Looked> out;
  if (!inputs.videos.empty()) {
    auto videos =
        uses_landmarks(method) ? looked_through(inputs, arguments) : timed(inputs, arguments);
    if (!videos) return pass(videos);
    out = std::move(*videos);
  }
  for (const fs::path& file : inputs.recordings) {
    auto recording = record::read_frame_recording(file);
    if (!recording) return pass(recording);
    if (!uses_landmarks(method) && uses_pictures(method))
      return fail(ErrorCode::InvalidArgument, file.string(),
                  "is a recording of landmarks; --method " + arguments.method +
                      " looks at pictures: give the video, or use --method landmarks");
    out.push_back({std::move(*recording), std::nullopt, nullptr});
  }
  return out;
}

/// world_from_sensor of a camera; one that is not in the file or below the floor is refused.
Result<Eigen::Isometry3d> place_of(const SensorId& camera, const std::string& places,
                                   const Registration& registration) {
  const auto found = registration.sensors.find(camera);
  if (found == registration.sensors.end())
    return fail(ErrorCode::NotFound, places,
                fmt::format("has no place for {0}; `chorus calibrate place --sensor {0}` writes it",
                            camera.str()));
  const Eigen::Isometry3d& place = found->second.world_from_sensor;
  if (!(place.translation().y() > 0.0))
    return fail(ErrorCode::InvalidArgument, places,
                fmt::format("{} stands {:.2f} m below the floor, which is at y = 0; is a sign of y "
                            "wrong?",
                            camera.str(), -place.translation().y()));
  return place;
}

/// Before a film is looked through, which takes as long as it plays.
Result<void> check_places(const PositionInputs& inputs, const std::string& places,
                          const Registration& registration) {
  for (const fs::path& video : inputs.videos) {
    const auto sensor = importers::sensor_for(video, {});
    if (!sensor) return pass(sensor);
    if (const auto place = place_of(*sensor, places, registration); !place) return pass(place);
  }
  return {};
}

/// Adds what the pictures show.
Result<void> add_sight(const Looked& looked, const PositionArguments& arguments, double stature,
                       CameraTake& camera) {
  VideoSights how{*looked.video, camera.world_from_sensor,
                  silhouette::usual_shape(stature, arguments.girth)};
  if (arguments.background == "mixtures") how.model = silhouette::BackgroundModel::Mixtures;
  how.empty_room = arguments.empty_room;
  how.masks = looked.masks;
  for (const SensorFrame& frame : camera.frames) how.times.push_back(frame.captured);
  auto sights = video_sights(std::move(how));
  if (!sights) return pass(sights);
  camera.sight = std::move(*sights);
  return {};
}

}  // namespace

Result<PositionInputs> sorted_inputs(const std::vector<std::string>& given) {
  PositionInputs out;
  for (const std::string& each : given) {
    const fs::path file(each);
    std::error_code failed;
    if (!fs::exists(file, failed)) return fail(ErrorCode::NotFound, each, "there is no such file");
    if (is_suit(file) && !out.suit.empty())
      return fail(ErrorCode::InvalidArgument, each, "is a second take of a suit; give one");
    if (is_suit(file)) {
      out.suit = file;
    } else {
      (file.extension() == ".mcap" ? out.recordings : out.videos).push_back(file);
    }
  }
  if (out.suit.empty())
    return fail(ErrorCode::InvalidArgument, "input",
                "a take of the suit is missing: a .bvh, .htr or .mvnx file");
  if (out.videos.empty() && out.recordings.empty())
    return fail(ErrorCode::InvalidArgument, "input",
                "a video is missing, or a camera's recording (.mcap)");
  return out;
}

Result<LearnedLength> found_size(const PositionArguments& arguments) {
  const fs::path file(arguments.size_from);
  Looked looked;
  if (file.extension() == ".mcap") {
    auto recording = record::read_frame_recording(file);
    if (!recording) return pass(recording);
    looked.recording = std::move(*recording);
  } else {
    const PositionInputs only{{file}, {}, {}};
    if (const auto ok = check_lenses(only, arguments); !ok) return pass(ok);
    auto videos = looked_through(only, arguments);
    if (!videos) return pass(videos);
    looked = std::move(videos->front());
  }
  if (auto size = positioning::size_by_depth(looked.recording.frames)) return size;
  const auto registration = server::load_registration_file(arguments.places);
  if (!registration) return pass(registration);
  const auto place = registration->sensors.find(looked.recording.sensor);
  if (place == registration->sensors.end())
    return fail(ErrorCode::NotFound, arguments.places,
                "has no place for " + looked.recording.sensor.str() +
                    ", which is to tell the person's size");
  return positioning::size_by_picture(looked.recording.frames, place->second.world_from_sensor);
}

Result<PlacedCameras> placed_cameras(const PositionInputs& inputs,
                                     const PositionArguments& arguments, double stature) {
  const Method method = *positioning::method_named(arguments.method);
  if (const auto ok = check_lenses(inputs, arguments); !ok) return pass(ok);
  if (arguments.background == "network" && method != Method::Both)
    return fail(ErrorCode::InvalidArgument, "--background",
                "network is for --method both: only there a network looks for an outline");
  const auto registration = server::load_registration_file(arguments.places);
  if (!registration) return pass(registration);
  if (const auto ok = check_places(inputs, arguments.places, *registration); !ok) return pass(ok);
  auto looked = all_looked(inputs, arguments, method);
  if (!looked) return pass(looked);
  PlacedCameras out;
  for (Looked& one : *looked) {
    const std::string name = one.recording.sensor.str();
    const auto place = place_of(one.recording.sensor, arguments.places, *registration);
    if (!place) return pass(place);
    CameraTake camera{one.recording.sensor, *place, std::move(one.recording.frames)};
    if (arguments.background == "network" && one.video && !one.masks)
      return fail(ErrorCode::InvalidArgument, name,
                  "the runner gives no masks; use --model blazepose-full, or --background median");
    if (uses_pictures(method) && one.video) {
      const auto added = add_sight(one, arguments, stature, camera);
      if (!added) return pass(added);
      out.notes.push_back(name + (one.masks ? ": outline from the network's mask"
                                            : ": outline from what differs from the room"));
    } else if (uses_pictures(method)) {
      out.notes.push_back(name + ": landmarks only; a recording has no pictures");
    }
    out.cameras.push_back(std::move(camera));
  }
  return out;
}

}  // namespace chorus::ctl
