// chorus position: puts the take of an inertial suit where cameras saw the person.
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/file.h"
#include "common/exporters/bvh.h"
#include "common/geometry/rotation.h"
#include "common/positioning/take.h"
#include "common/record/frame_recording.h"
#include "common/report/report_files.h"
#include "common/suit/suit_file.h"
#include "common/suit/walk.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/convert/video_import.h"
#include "services/ctl/evaluate/position_report.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using positioning::CameraTake;

constexpr std::uintmax_t kMaxPlacesFile = 1u << 22;
// Of a joint within the pose: three degrees over an arm's or a leg's bones [m].
constexpr double kJointSigma = 0.03;

struct PositionArguments {
  std::vector<std::string> inputs;  ///< Videos or recordings, then the suit's file.
  std::string places;
  std::vector<std::string> lenses;
  std::string model = "blazepose-full";
  std::string method = "landmarks";
  double stature = 0.0;
  double offset_s = 0.0;
  bool offset_stated = false;
  double search_s = 2.0;
  double rate_hz = 30.0;
  std::string out;
};

bool is_suit(const fs::path& file) {
  const std::string ending = file.extension().string();
  return ending == ".bvh" || ending == ".BVH" || ending == ".mvnx" || ending == ".MVNX";
}

struct Inputs {
  std::vector<fs::path> videos;
  std::vector<fs::path> recordings;
  fs::path suit;
};

Result<Inputs> sorted_inputs(const std::vector<std::string>& given) {
  Inputs out;
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
                "a take of the suit is missing: a .bvh or .mvnx file");
  if (out.videos.empty() && out.recordings.empty())
    return fail(ErrorCode::InvalidArgument, "input",
                "a video is missing, or a camera's recording (.mcap)");
  return out;
}

/// What the cameras saw: videos are looked through, recordings are read.
Result<std::vector<record::FrameRecording>> cameras_of(const Inputs& inputs,
                                                       const PositionArguments& arguments) {
  std::vector<record::FrameRecording> out;
  if (!inputs.videos.empty()) {
    if (arguments.lenses.empty())
      return fail(ErrorCode::InvalidArgument, "--intrinsics",
                  "is missing: the camera's lens, as `chorus calibrate camera` writes it");
    auto set =
        import_videos(inputs.videos, {}, {arguments.lenses, arguments.model, arguments.rate_hz});
    if (!set) return pass(set);
    out = std::move(set->recordings);
  }
  for (const fs::path& file : inputs.recordings) {
    auto recording = record::read_frame_recording(file);
    if (!recording) return pass(recording);
    out.push_back(std::move(*recording));
  }
  return out;
}

Result<std::vector<CameraTake>> placed_cameras(std::vector<record::FrameRecording> recordings,
                                               const std::string& places) {
  const auto text = read_file(places, kMaxPlacesFile);
  if (!text) return pass(text);
  const auto registration = wire::read_registration(*text);
  if (!registration) return pass(registration);
  std::vector<CameraTake> out;
  for (record::FrameRecording& recording : recordings) {
    const auto known = registration->sensors.find(recording.sensor);
    if (known == registration->sensors.end())
      return fail(ErrorCode::NotFound, places,
                  fmt::format("has no place for {}; `chorus calibrate place --sensor {}` writes it",
                              recording.sensor.str(), recording.sensor.str()));
    out.push_back({recording.sensor, known->second.world_from_sensor, std::move(recording.frames)});
  }
  return out;
}

Result<void> write_bvh(const positioning::TakeResult& result, double rate_hz,
                       const fs::path& file) {
  exporters::PersonTrack track{PersonId{1}, {}};
  for (const positioning::Placed& one : result.placed)
    track.poses.push_back({placed(one.pose, one.smooth.heading, one.smooth.place)});
  const auto fit = exporters::fit_skeleton(track);
  if (!fit) return pass(fit);
  return write_text(file.string(), exporters::bvh_of(*fit, rate_hz));
}

/// One sensor whose space is the world.
record::FrameRecording recording_of(const positioning::TakeResult& result, Timestamp start,
                                    const std::string& method) {
  record::FrameRecording out;
  out.sensor = SensorId::parse("positioner").value();
  out.device = "inertial suit before cameras (" + method + ")";
  out.floor = FloorPlane{};
  std::uint64_t sequence = 0;
  for (const positioning::Placed& one : result.placed) {
    SensorFrame frame;
    frame.sensor = out.sensor;
    frame.sequence = ++sequence;
    frame.captured = frame.received = start + one.time;
    frame.floor = out.floor;
    Skeleton<WorldSpace> body = placed(one.pose, one.smooth.heading, one.smooth.place);
    const Covariance covariance(Eigen::Matrix3d(
        one.smooth.covariance + kJointSigma * kJointSigma * Eigen::Matrix3d::Identity()));
    for (Joint& joint : body.joints) {
      if (joint.seen()) joint.covariance = covariance;
    }
    frame.bodies.push_back(
        {BodyId{1}, frame.captured, to_sensor(Eigen::Isometry3d::Identity(), body)});
    out.frames.push_back(std::move(frame));
  }
  return out;
}

std::vector<Eigen::Vector3d> walked_places(const positioning::TakeResult& result, double stature) {
  suit::Walk walk(stature);
  std::vector<Eigen::Vector3d> out;
  const positioning::Position& first = result.placed.front().smooth;
  for (const positioning::Placed& one : result.placed) {
    const Eigen::Vector3d place = walk.next(one.pose).place;
    Eigen::Vector3d at = about_y(first.heading) * place;
    at.x() += first.place.x();
    at.z() += first.place.z();
    out.push_back(at);
  }
  return out;
}

Result<void> write_all(const PositionArguments& arguments, const PositionReport& report,
                       Timestamp start) {
  const fs::path folder(arguments.out);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return fail(ErrorCode::Io, arguments.out, failed.message());
  const fs::path recording = folder / "position.mcap";
  fs::remove(recording, failed);
  auto ok = write_bvh(report.result, arguments.rate_hz, folder / "corrected.bvh");
  if (ok)
    ok = record::write_frame_recording(recording,
                                       recording_of(report.result, start, arguments.method));
  if (ok) ok = report::write_reports(position_report(report), folder, "report");
  return ok;
}

Result<int> run_position(const PositionArguments& arguments) {
  const auto inputs = sorted_inputs(arguments.inputs);
  if (!inputs) return pass(inputs);
  const auto suit = suit::read_suit_file(inputs->suit, {.stature = arguments.stature});
  if (!suit) return pass(suit);
  auto recordings = cameras_of(*inputs, arguments);
  if (!recordings) return pass(recordings);
  const auto cameras = placed_cameras(std::move(*recordings), arguments.places);
  if (!cameras) return pass(cameras);
  positioning::TakeSettings settings;
  settings.rate_hz = arguments.rate_hz;
  settings.farthest_s = arguments.search_s;
  if (arguments.offset_stated) settings.offset_s = arguments.offset_s;
  settings.start =
      cameras->front().frames.empty() ? Timestamp{} : cameras->front().frames.front().captured;
  const double stature = suit::stature_of(suit->poses.front());
  if (stature > 0.0) settings.tracker.stature = stature;
  Progress progress(std::cerr, on_terminal(), "placing");
  const auto result = positioning::place_take(*cameras, *suit, settings,
                                              [&](double share) { progress.show(share, {}); });
  progress.finish();
  if (!result) return pass(result);
  const PositionReport report{{{"suit", inputs->suit.filename().string()},
                               {"places", fs::path(arguments.places).filename().string()},
                               {"stature", fmt::format("{:.2f} m", stature)}},
                              *result,
                              *cameras,
                              arguments.method,
                              walked_places(*result, settings.tracker.stature)};
  if (const auto ok = write_all(arguments, report, settings.start); !ok) return pass(ok);
  std::cout << position_text(report)
            << fmt::format("wrote corrected.bvh, position.mcap and report.html to {}\n",
                           arguments.out);
  return kExitOk;
}

}  // namespace

Run add_position(CLI::App& options) {
  const auto arguments = std::make_shared<PositionArguments>();
  options
      .add_option("input", arguments->inputs,
                  "Videos (or recordings of cameras, .mcap), and the suit's take (.bvh, .mvnx)")
      ->required();
  options
      .add_option("--place", arguments->places,
                  "Where the cameras stand, as `chorus calibrate place` writes it")
      ->required();
  options.add_option("--intrinsics", arguments->lenses,
                     "The lens: one file for all videos, or one for each");
  options.add_option("--out", arguments->out, "Folder for the results")->required();
  options.add_option("--stature", arguments->stature, "The person's height [m]")
      ->check(number_range(0.5, 2.5));
  options.add_option("--model", arguments->model, "Of the runner that looks at the videos")
      ->capture_default_str();
  CLI::Option* const offset =
      options.add_option("--clock-offset", arguments->offset_s,
                         "Added to the suit's time to get the first video's [s]; default: found");
  options
      .add_option("--search", arguments->search_s, "Largest offset of the clocks that is tried [s]")
      ->check(number_range(0.1, 60.0))
      ->capture_default_str();
  options.add_option("--rate", arguments->rate_hz, "Of the result [Hz]")
      ->check(number_range(5.0, 120.0))
      ->capture_default_str();
  return [arguments, offset] {
    arguments->offset_stated = offset->count() > 0;
    return run_position(*arguments);
  };
}

}  // namespace chorus::ctl
