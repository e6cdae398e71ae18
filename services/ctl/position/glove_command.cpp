// chorus glove: puts a glove's take where a camera saw the hand.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/median.h"
#include "common/base/units.h"
#include "common/hand/bvh.h"
#include "common/hand/size_check.h"
#include "services/ctl/calibrate/lens_file.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"
#include "services/sensor/device/camera/video.h"
#include "services/sensor/device/glove/glove_eye.h"

namespace chorus::ctl {
namespace {

constexpr std::size_t kMostPictures = 1'000'000;  // Nine hours at 30 Hz.
// Outlines farther apart are doubted [m]: a drawn glove has 1 mm, a real video of a walking person
// whose shadow was taken for a glove 34 mm.  No real glove was tried.
constexpr double kDoubted = 0.015;
constexpr double kFewSeen = 0.1;  // A smaller share of the pictures places no take.

struct GloveArguments {
  std::string video;
  std::string lens;
  std::string find = "dark";
  std::string out;
  bool placed_take = false;
  glove::GloveSettings settings;
};

/// What came of a video.
struct GlovePath {
  std::vector<hand::Pose>
      poses;  ///< In the world, one for each picture from the first seen one on.
  double rate_hz = 30.0;
  std::size_t pictures = 0;
  std::size_t seen = 0;
  std::string unseen;             ///< Why the hand was last not found.
  std::vector<double> distances;  ///< From the camera [m].
  std::vector<double> told;       ///< The same, where the take puts the wrist.
  std::vector<double> sigmas;     ///< Along the line of sight [m].
  std::vector<double> apart;      ///< Outline of the hand and of what is seen, at its distance [m].
};

/// `told`: where the take puts the wrist.
void add(GlovePath& path, const glove::GloveEye& eye, const Result<glove::PlacedHand>& placed,
         const Eigen::Vector3d& told) {
  ++path.pictures;
  if (!placed) {
    path.unseen = to_string(placed.error());
    if (!path.poses.empty()) path.poses.push_back(path.poses.back());
    return;
  }
  ++path.seen;
  const Eigen::Vector3d sight = placed->place.wrist.normalized();
  path.distances.push_back(placed->place.wrist.norm());
  path.told.push_back((told - eye.world_from_camera().translation()).norm());
  path.sigmas.push_back(std::sqrt(sight.dot(placed->place.covariance * sight)));
  if (std::isfinite(placed->apart)) path.apart.push_back(placed->apart);
  hand::Pose pose = placed->pose;
  pose.wrist = eye.world_from_camera() * pose.wrist;
  pose.turn = Eigen::Quaterniond(eye.world_from_camera().linear()) * pose.turn;
  path.poses.push_back(pose);
}

Result<GlovePath> path_of(const GloveArguments& arguments, glove::GloveEye& eye) {
  auto video = camera::open_video(arguments.settings.camera);
  if (!video) return pass(video);
  const camera::FileTiming timing = (*video)->timing();
  GlovePath path;
  Progress progress(std::cerr, on_terminal(), "placing");
  if (timing.step > Duration{0}) path.rate_hz = 1.0 / seconds(timing.step);
  while (path.pictures < kMostPictures) {
    const auto moment = (*video)->next();
    if (!moment) return pass(moment);
    if (!*moment) break;
    const auto picture = (*video)->picture();
    if (!picture) continue;  // The picture is damaged.
    const double at =
        static_cast<double>(path.pictures) / path.rate_hz - arguments.settings.clock_offset_s;
    const auto placed = eye.look(*picture, at);
    if (!placed && placed.error().code != ErrorCode::NotFound) return pass(placed);
    add(path, eye, placed, hand::pose_at(eye.take(), at).wrist);
    if (timing.length)
      progress.show(static_cast<double>(path.pictures) / path.rate_hz / seconds(*timing.length),
                    {});
  }
  progress.finish();
  if (path.pictures == 0)
    return fail(ErrorCode::InvalidArgument, arguments.video,
                "no pictures can be read from the file; is it a video?");
  return path;
}

std::string text_of(const GlovePath& path, const glove::GloveEye& eye) {
  std::string text = fmt::format("{} hand found in {} of {} pictures\n",
                                 name_of(eye.skeleton().side), path.seen, path.pictures);
  if (path.seen < path.pictures) text += "  last not found: " + printable(path.unseen) + "\n";
  if (path.seen == 0) return text;
  text += fmt::format("  distance {:.2f} m, known to {:.0f} mm along the line of sight (median)\n",
                      median(path.distances), to_mm(median(path.sigmas)));
  if (!path.apart.empty())
    text += fmt::format("  outlines of the hand and of what is seen lie {:.0f} mm apart (median)\n",
                        to_mm(median(path.apart)));
  if (!path.apart.empty() && median(path.apart) > kDoubted)
    text += "  doubt: what is seen is not shaped like the hand; is the glove the darkest thing?\n";
  if (eye.skeleton().relative)
    text +=
        "  note: the hand was scanned without a scale, so its distance is as uncertain as its size "
        "(5 %)\n";
  return text;
}

/// Whether the hand's size fits where the take puts the wrist.
std::string size_text(const GlovePath& path) {
  const hand::SizeCheck check = hand::check_size(path.distances, path.told, path.rate_hz);
  const std::string found = fmt::format("{:.1f} % (standard deviation {:.1f} %)",
                                        100.0 * (check.factor - 1.0), 100.0 * check.sigma);
  return check.wrong() ? "  the hand's size is wrong: by the take's place it is larger by " +
                             found + "; scan it again\n"
                       : "  the hand's size fits the take's place: larger by " + found + "\n";
}

Result<int> run_glove(GloveArguments arguments) {
  const auto lens = read_lens_file(arguments.lens);
  if (!lens) return pass(lens);
  glove::GloveSettings& settings = arguments.settings;
  settings.camera = *lens;
  settings.camera.source = arguments.video;
  settings.camera.model = "hands";
  settings.find =
      arguments.find == "network" ? glove::GloveFinding::Network : glove::GloveFinding::Dark;
  if (const auto ok = may_write(arguments.out, {arguments.video, settings.take, settings.hand,
                                                settings.places, arguments.lens});
      !ok)
    return pass(ok);
  auto eye = glove::GloveEye::open(settings);
  if (!eye) return pass(eye);
  const auto path = path_of(arguments, *eye);
  if (!path) return pass(path);
  std::cout << text_of(*path, *eye);
  if (arguments.placed_take && path->seen > 0) std::cout << size_text(*path);
  if (path->seen == 0) return kExitFailed;
  if (static_cast<double>(path->seen) < kFewSeen * static_cast<double>(path->pictures)) {
    std::cerr << "chorus glove: too few pictures show the hand; nothing is written\n";
    return kExitFailed;
  }
  const std::string bvh = hand::bvh_of(eye->skeleton(), path->poses, path->rate_hz);
  if (const auto ok = write_text(arguments.out, bvh); !ok) return pass(ok);
  std::cout << fmt::format("wrote {}\n", arguments.out);
  return kExitOk;
}

}  // namespace

Run add_glove(CLI::App& options) {
  const auto arguments = std::make_shared<GloveArguments>();
  glove::GloveSettings& settings = arguments->settings;
  options.add_option("video", arguments->video, "What the camera saw")->required();
  options
      .add_option("take", settings.take,
                  "How the glove says the hand is held: a .bvh over the hand's skeleton")
      ->required();
  options.add_option("--hand", settings.hand, "The hand: the .json that `chorus scan` wrote")
      ->required();
  options
      .add_option("--intrinsics", arguments->lens,
                  "The lens, as `chorus calibrate camera` writes it")
      ->required();
  options.add_option("--place", settings.places,
                     "Where the camera stands, as `chorus calibrate place` writes it; default: "
                     "level, looking along the take's +z");
  options.add_option("--camera", settings.camera_name, "The camera's name in that file");
  options.add_option("--find", arguments->find, "dark: a black glove; network: any hand")
      ->check(CLI::IsMember({"dark", "network"}))
      ->capture_default_str();
  options.add_option("--darkest", settings.darkest, "Pixels up to this grey level are glove")
      ->check(number_range(1.0, 254.0))
      ->capture_default_str();
  options.add_option("--clock-offset", settings.clock_offset_s,
                     "Added to the take's time to get the video's [s]");
  options.add_flag("--placed", arguments->placed_take,
                   "The take has its place in the camera's world (as `chorus position` writes it): "
                   "tell whether the hand's size fits");
  options.add_option("--out", arguments->out, "The take with its place: a .bvh")->required();
  return [arguments] { return run_glove(*arguments); };
}

}  // namespace chorus::ctl
