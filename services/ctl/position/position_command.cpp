// chorus position: puts the take of an inertial suit where cameras saw the person.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/exporters/bvh.h"
#include "common/geometry/rotation.h"
#include "common/positioning/recalibrate.h"
#include "common/positioning/take.h"
#include "common/record/frame_recording.h"
#include "common/report/report_files.h"
#include "common/suit/suit_file.h"
#include "common/suit/walk.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"
#include "services/ctl/position/position_inputs.h"
#include "services/ctl/position/position_report.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;

// Of a joint within the pose: three degrees over an arm's or a leg's bones [m].
constexpr double kJointSigma = 0.03;

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
  const fs::path recording = folder / "position.mcap";
  fs::remove(recording, failed);
  auto ok = write_bvh(report.result, arguments.rate_hz, folder / "corrected.bvh");
  if (ok)
    ok = record::write_frame_recording(recording,
                                       recording_of(report.result, start, arguments.method));
  if (ok) ok = report::write_reports(position_report(report), folder, "report");
  return ok;
}

/// Nothing that is read may be written over, and the folder can be made.  A result of an earlier
/// run is replaced.
Result<void> check_out(const PositionArguments& arguments) {
  const fs::path folder(arguments.out);
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed || !fs::is_directory(folder))
    return fail(ErrorCode::Io, arguments.out,
                "is to be the folder of the results, and cannot be made; name another one");
  std::vector<std::string> read = arguments.inputs;
  read.insert(read.end(), {arguments.places, arguments.size_from, arguments.empty_room});
  read.insert(read.end(), arguments.lenses.begin(), arguments.lenses.end());
  for (const char* name : {"corrected.bvh", "position.mcap", "report.html", "report.json"})
    for (const std::string& input : read)
      if (same_file((folder / name).string(), input))
        return fail(ErrorCode::InvalidArgument, arguments.out,
                    fmt::format("{} in it is what is read here; name another folder", name));
  return {};
}

Result<positioning::TakeSettings> settings_of(const PositionArguments& arguments,
                                              const suit::SuitTake& suit) {
  positioning::TakeSettings settings;
  settings.rate_hz = arguments.rate_hz;
  settings.clocks.farthest_s = arguments.search_s;
  if (arguments.offset_stated) settings.clocks.offset_s = arguments.offset_s;
  const double stature = suit::stature_of(suit.poses.front());
  if (stature > 0.0) settings.tracker.stature = stature;
  settings.tracker.method = *positioning::method_named(arguments.method);
  if (arguments.heading_stated) settings.tracker.heading = deg(arguments.heading_deg);
  if (arguments.start.empty()) return settings;
  std::vector<double> numbers;
  for (const std::string& word : CLI::detail::split(arguments.start, ',')) {
    double number = 0.0;
    if (!CLI::detail::lexical_cast(word, number) || !(std::abs(number) < 1000.0)) break;
    numbers.push_back(number);
  }
  if (numbers.size() != 2)
    return fail(ErrorCode::InvalidArgument, "--start", "is x,z in metres, as in 0.5,-1.2");
  settings.tracker.start = Eigen::Vector3d(numbers[0], 0.0, numbers[1]);
  return settings;
}

/// What is told of bones that were found anew, those that changed first.
std::vector<std::string> notes_of(positioning::Recalibration found) {
  std::vector<std::string> notes{
      fmt::format("recalibrated by {} pictures: joints lie {:.2f} degrees from their landmarks "
                  "(median), {:.2f} before",
                  found.pictures, to_deg(found.after), to_deg(found.before))};
  std::ranges::stable_sort(found.bones, std::ranges::greater{}, &positioning::BoneFound::turn);
  std::string left;
  for (const positioning::BoneFound& bone : found.bones) {
    if (found.added[index_of(bone.end)].isZero()) {
      left += fmt::format("{}{} ({:.0f} degrees)", left.empty() ? "" : ", ", name_of(bone.end),
                          2.0 * to_deg(bone.turn_sigma));
      continue;
    }
    notes.push_back(fmt::format(
        "bone to {}: turned by {:.1f} degrees (sigma {:.1f}), {:+.1f} % longer (sigma {:.1f})",
        name_of(bone.end), to_deg(bone.turn), to_deg(bone.turn_sigma), 100.0 * (bone.stretch - 1.0),
        100.0 * bone.stretch_sigma));
  }
  if (!left.empty())
    notes.push_back(
        "bones as the suit has them, because landmarks beside their joints may look "
        "like a turn of as much as this: " +
        left);
  return notes;
}

/// The take with the bones that the cameras tell, if that is asked; its places stay.
Result<std::vector<std::string>> recalibrate_take(const PositionArguments& arguments,
                                                  const PlacedCameras& cameras, Timestamp start,
                                                  positioning::TakeResult& result) {
  if (!arguments.recalibrate) return std::vector<std::string>{};
  const auto found = positioning::recalibrate(cameras.cameras, result, start);
  if (!found) return pass(found);
  for (positioning::Placed& one : result.placed)
    one.pose = positioning::recalibrated(one.pose, *found);
  return notes_of(*found);
}

/// States the stature by what --size-from names; what is told of it.
Result<std::vector<std::string>> take_size(PositionArguments& arguments) {
  if (arguments.size_from.empty()) return std::vector<std::string>{};
  const auto size = found_size(arguments);
  if (!size) return pass(size);
  arguments.stature = size->length;
  return std::vector{fmt::format("stature {:.2f} m (sigma {:.2f}) by {}", size->length, size->sigma,
                                 fs::path(arguments.size_from).filename().string())};
}

Result<int> run_position(PositionArguments arguments) {
  const auto inputs = sorted_inputs(arguments.inputs);
  if (!inputs) return pass(inputs);
  if (const auto ok = check_out(arguments); !ok) return pass(ok);
  auto notes = take_size(arguments);
  if (!notes) return pass(notes);
  const auto suit = suit::read_suit_file(inputs->suit, {.stature = arguments.stature});
  if (!suit) return pass(suit);
  auto settings = settings_of(arguments, *suit);
  if (!settings) return pass(settings);
  const auto cameras = placed_cameras(*inputs, arguments, settings->tracker.stature);
  if (!cameras) return pass(cameras);
  settings->clocks.start = cameras->cameras.front().frames.empty()
                               ? Timestamp{}
                               : cameras->cameras.front().frames.front().captured;
  Progress progress(std::cerr, on_terminal(), "placing");
  auto result = positioning::place_take(cameras->cameras, *suit, *settings,
                                        [&](double share) { progress.show(share, {}); });
  progress.finish();
  if (!result) return pass(result);
  auto found = recalibrate_take(arguments, *cameras, settings->clocks.start, *result);
  if (!found) return pass(found);
  for (const auto& more : {suit->notes, cameras->notes, *found})
    notes->insert(notes->end(), more.begin(), more.end());
  const PositionReport report{{{"suit", inputs->suit.filename().string()},
                               {"places", fs::path(arguments.places).filename().string()},
                               {"stature", fmt::format("{:.2f} m", settings->tracker.stature)}},
                              *result,
                              cameras->cameras,
                              arguments.method,
                              walked_places(*result, settings->tracker.stature),
                              *notes,
                              settings->tracker.stature};
  if (const auto ok = write_all(arguments, report, settings->clocks.start); !ok) return pass(ok);
  for (const std::string& note : *notes) std::cout << note << '\n';
  std::cout << position_text(report)
            << fmt::format("wrote corrected.bvh, position.mcap and report.html to {}\n",
                           arguments.out);
  return kExitOk;
}

/// What the results are made from, and where they go.
void add_inputs(CLI::App& options, PositionArguments& into) {
  options
      .add_option(
          "input", into.inputs,
          "Videos (or recordings of cameras, .mcap), and the suit's take (.bvh, .htr, .mvnx)")
      ->required();
  options
      .add_option("--place", into.places,
                  "Where the cameras stand, as `chorus calibrate place` writes it")
      ->required();
  options.add_option("--intrinsics", into.lenses,
                     "The lens: one file for all videos, or one for each");
  options.add_option("--out", into.out, "Folder for the results")->required();
}

void add_person(CLI::App& options, PositionArguments& into) {
  CLI::Option* const stature =
      options.add_option("--stature", into.stature, "The person's height [m]")
          ->check(number_range(0.5, 2.5));
  options
      .add_option("--size-from", into.size_from,
                  "What tells the height: a depth camera's recording (.mcap), or a recording or "
                  "video of the person standing before a placed camera")
      ->excludes(stature);
  options.add_option("--girth", into.girth, "Of the person, relative to a usual one")
      ->check(number_range(0.5, 2.0))
      ->capture_default_str();
  options.add_flag("--recalibrate", into.recalibrate,
                   "Find bones and constant turns of the suit's segments by the cameras, from a "
                   "walk of a minute");
}

void add_method(CLI::App& options, PositionArguments& into) {
  const auto methods = positioning::method_names();
  options
      .add_option("--method", into.method,
                  "both: landmarks and outline; silhouettes: Madaras et al.; suit: steps alone")
      ->check(CLI::IsMember(std::vector<std::string>(methods.begin(), methods.end())))
      ->capture_default_str();
  options
      .add_option(
          "--background", into.background,
          "What tells the outline: a network's mask, or what differs from the room's median "
          "or mixtures; auto: the mask if there is one, else the median")
      ->check(CLI::IsMember({"auto", "network", "median", "mixtures"}))
      ->capture_default_str();
  options.add_option(
      "--empty-room", into.empty_room,
      "A picture or video of the room without the person; default: the video itself");
  options.add_option("--model", into.model, "Of the runner that looks at the videos")
      ->capture_default_str();
}

struct Stated {
  CLI::Option* heading;
  CLI::Option* offset;
};

/// Where and when the suit begins, which is found unless it is stated.
Stated add_beginning(CLI::App& options, PositionArguments& into) {
  options.add_option("--start", into.start,
                     "Where the person is at first: x,z [m]; default: found (suit: the origin)");
  CLI::Option* const heading = options.add_option(
      "--heading", into.heading_deg, "Of the suit's world in the cameras' [deg]; default: found");
  CLI::Option* const offset = options.add_option(
      "--clock-offset", into.offset_s,
      "Added to the suit's time to get the first video's [s]; default: found, as those "
      "of other videos are");
  options.add_option("--search", into.search_s, "Largest offset of the clocks that is tried [s]")
      ->check(number_range(0.1, 60.0))
      ->capture_default_str();
  options.add_option("--rate", into.rate_hz, "Of the result [Hz]")
      ->check(number_range(5.0, 120.0))
      ->capture_default_str();
  return {heading, offset};
}

}  // namespace

Run add_position(CLI::App& options) {
  const auto arguments = std::make_shared<PositionArguments>();
  add_inputs(options, *arguments);
  add_person(options, *arguments);
  add_method(options, *arguments);
  const Stated stated = add_beginning(options, *arguments);
  return [arguments, stated] {
    arguments->offset_stated = stated.offset->count() > 0;
    arguments->heading_stated = stated.heading->count() > 0;
    return run_position(*arguments);
  };
}

}  // namespace chorus::ctl
