// chorus scan: a hand's skeleton from scans or photos of an open hand.
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/base/units.h"
#include "common/hand/bvh.h"
#include "common/hand/htr.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/photo_files.h"
#include "services/ctl/line/text_file.h"
#include "services/sensor/device/camera/shipped_runner.h"
#include "services/sensor/device/scan/hand_scan.h"

namespace chorus::ctl {
namespace {

namespace fs = std::filesystem;
using scan::HandScan;
using scan::ScaleBy;
using scan::ScannedHand;

struct ScanArguments {
  std::vector<std::string> sources;
  double dpi = 0.0;
  std::string paper;
  bool card = false;
  std::string method = "best";
  std::string view = "palm";
  std::vector<std::string> runner;
  bool no_network = false;
  std::string out;
  bool json = false;
};

HandScan scan_of(const ScanArguments& arguments) {
  HandScan how;
  how.dpi = arguments.dpi;
  if (arguments.dpi > 0.0) how.scale = ScaleBy::Dpi;
  if (!arguments.paper.empty()) how.scale = ScaleBy::A4;
  if (arguments.card) how.scale = ScaleBy::Card;
  how.options.paper = arguments.method == "paper";
  how.options.back = arguments.view == "back";
  return how;
}

/// The network, or none: then the outline alone answers, and that is said.
std::optional<camera::HandFinder> network_of(const ScanArguments& arguments) {
  if (arguments.no_network || arguments.method != "best") return std::nullopt;
  camera::CameraSettings settings;
  settings.runner = arguments.runner;
  if (settings.runner.empty()) settings.model = "hands";
  const auto command = camera::runner_command(settings);
  auto finder = command ? camera::HandFinder::start(*command)
                        : Result<camera::HandFinder>(tl::unexpected<Error>(command.error()));
  if (finder) return std::move(*finder);
  std::cerr << fmt::format(
      "without a network: {}\nThe outline alone answers: it cannot tell palm from back (--view), "
      "and "
      "divides fingers as they usually are.\n",
      to_string(finder.error()));
  return std::nullopt;
}

std::string table_of(const ScannedHand& hand) {
  std::vector<std::vector<std::string>> rows{
      {"finger", "part 1", "part 2", "part 3", "free", "width"}};
  const double scale = hand.skeleton.palm_radius / hand.shape.outline.palm_radius;
  for (std::size_t f = 0; f < hand::kFingers; ++f) {
    std::vector<std::string> row{std::string(hand::kFingerNames[f])};
    for (std::size_t i = 1; i < hand::kFingerJoints; ++i)
      row.push_back(shown(to_mm(part_length(hand.skeleton, f, i)), 1));
    row.push_back(shown(to_mm(scale * hand.shape.fingers[f].length()), 1));
    row.push_back(hand.skeleton.widths[f] > 0.0 ? shown(to_mm(hand.skeleton.widths[f]), 1) : "-");
    rows.push_back(std::move(row));
  }
  return table(std::move(rows));
}

std::string text_of(const ScannedHand& hand) {
  const std::string scale = hand.skeleton.relative
                                ? "relative: no scale is known, a hand of 187 mm is assumed"
                                : "scale from " + hand.record.scale_from;
  std::string text = fmt::format("{}: {} hand, {} seen, {:.0f} mm from wrist to tip ({})\n{}",
                                 printable(hand.record.source), name_of(hand.skeleton.side),
                                 hand.shape.back_seen ? "back" : "palm",
                                 to_mm(length_of(hand.skeleton)), scale, table_of(hand));
  for (const std::string& note : hand.shape.notes) text += "  note: " + printable(note) + "\n";
  return text;
}

/// Beside a scan hand.png its skeleton hand.bvh has another picture.
fs::path annotated_picture(fs::path skeleton) {
  return skeleton.replace_extension(".annotated.png");
}

/// The three files of a hand beside each other: .bvh or .htr, .json and .annotated.png.
Result<void> write_hand(const ScannedHand& hand, const hand::Skeleton& skeleton,
                        const fs::path& out) {
  const std::string text =
      out.extension() == ".htr" ? hand::htr_of(skeleton) : hand::bvh_of(skeleton);
  if (auto ok = write_text(out.string(), text); !ok) return ok;
  fs::path file = out;
  const std::string json = hand::scan_json(hand.shape, skeleton, hand.record);
  if (auto ok = write_text(file.replace_extension(".json").string(), json); !ok) return ok;
  std::vector<unsigned char> png;
  if (!cv::imencode(".png", *hand.drawn, png))
    return fail(ErrorCode::Internal, out.string(), "no picture");
  return write_text(annotated_picture(out).string(),
                    {reinterpret_cast<const char*>(png.data()), png.size()});
}

struct Scanned {
  std::vector<ScannedHand> hands;
  std::size_t refused = 0;
};

void tell(const ScannedHand& hand, const ScanArguments& arguments) {
  if (arguments.json)
    std::cout << hand::scan_json(hand.shape, hand.skeleton, hand.record);
  else
    std::cout << text_of(hand);
}

Result<Scanned> scan_all(const ScanArguments& arguments, const std::vector<std::string>& files) {
  auto finder = network_of(arguments);
  const HandScan how = scan_of(arguments);
  Scanned out;
  for (const std::string& file : files) {
    auto hand = scan_hand(file, how, finder ? &*finder : nullptr);
    if (!hand && files.size() == 1) return pass(hand);
    if (!hand) {
      ++out.refused;
      std::cerr << "refused: " << printable(to_string(hand.error())) << "\n";
      continue;
    }
    tell(*hand, arguments);
    out.hands.push_back(std::move(*hand));
  }
  return out;
}

bool is_skeleton(const std::string& out) {
  const fs::path ending = fs::path(out).extension();
  return ending == ".bvh" || ending == ".htr";
}

/// Where the skeleton of a picture is written: `out` itself, or a file in that folder.
fs::path skeleton_for(const fs::path& out, const fs::path& picture) {
  return is_skeleton(out.string()) ? out : out / (picture.stem().string() + ".bvh");
}

/// Files of other programs are not taken for names of folders.
Result<void> check_out(const std::string& out) {
  constexpr std::array<std::string_view, 7> kOthers{".sk",   ".fbx", ".glb", ".gltf",
                                                    ".json", ".png", ".usd"};
  const std::string ending = fs::path(out).extension().string();
  if (std::find(kOthers.begin(), kOthers.end(), ending) == kOthers.end()) return {};
  if (ending == ".sk")
    return fail(ErrorCode::Unsupported, out,
                "Synertial does not publish how its .sk files are laid out; write a .bvh or .htr");
  return fail(ErrorCode::Unsupported, out, "a hand is written as .bvh or .htr, or into a folder");
}

/// Nothing that is read may be written over; a folder can be made.
Result<void> check_files(const ScanArguments& arguments, const std::vector<std::string>& files) {
  if (arguments.out.empty()) return {};
  if (!is_skeleton(arguments.out)) {
    std::error_code failed;
    fs::create_directories(arguments.out, failed);
    if (failed) return fail(ErrorCode::Io, arguments.out, "no folder: " + failed.message());
  }
  for (const std::string& file : files) {
    const fs::path skeleton = skeleton_for(arguments.out, file);
    for (const fs::path& written : {skeleton, annotated_picture(skeleton)})
      if (auto ok = may_write(written.string(), {files.begin(), files.end()}); !ok) return ok;
  }
  return {};
}

/// One file for each hand, or one for all pictures of one hand.
Result<void> write_all(const ScanArguments& arguments, const Scanned& scanned) {
  if (scanned.hands.empty() || arguments.out.empty()) return {};
  if (is_skeleton(arguments.out)) {
    std::vector<hand::Skeleton> shots;
    for (const ScannedHand& each : scanned.hands) shots.push_back(each.skeleton);
    const auto skeleton = hand::median_of(shots);
    if (!skeleton) return pass(skeleton);
    return write_hand(scanned.hands.front(), *skeleton, arguments.out);
  }
  for (const ScannedHand& each : scanned.hands) {
    const fs::path file = skeleton_for(arguments.out, each.record.source);
    if (auto ok = write_hand(each, each.skeleton, file); !ok) return ok;
  }
  return {};
}

Result<int> run_scan(const ScanArguments& arguments) {
  const int scales =
      (arguments.dpi > 0.0 ? 1 : 0) + (arguments.paper.empty() ? 0 : 1) + (arguments.card ? 1 : 0);
  if (scales > 1)
    return fail(ErrorCode::InvalidArgument, "scale", "say one of --dpi, --paper and --card");
  if (const auto ok = check_out(arguments.out); !ok) return pass(ok);
  const auto files = photo_files(arguments.sources);
  if (!files) return pass(files);
  if (const auto ok = check_files(arguments, *files); !ok) return pass(ok);
  const auto scanned = scan_all(arguments, *files);
  if (!scanned) return pass(scanned);
  if (const auto ok = write_all(arguments, *scanned); !ok) return pass(ok);
  if (!arguments.json && !arguments.out.empty() && !scanned->hands.empty())
    std::cout << fmt::format(
        "wrote {}: skeleton (.bvh or .htr), lengths (.json), annotated picture (.annotated.png)\n",
        arguments.out);
  if (files->size() > 1)
    std::cerr << fmt::format("{} of {} pictures show a hand\n", scanned->hands.size(),
                             files->size());
  return scanned->hands.empty() ? kExitFailed : kExitOk;
}

void add_scale(CLI::App& options, ScanArguments& arguments) {
  options.add_option("--dpi", arguments.dpi, "Pixels per inch; default: what the file states")
      ->check(number_range(20.0, 4800.0));
  options
      .add_option("--paper", arguments.paper,
                  "The picture is a whole sheet, or shows one with all its corners below the hand")
      ->check(CLI::IsMember({"a4"}));
  options.add_flag("--card", arguments.card, "A bank card lies beside the hand");
}

}  // namespace

Run add_scan(CLI::App& options) {
  const auto arguments = std::make_shared<ScanArguments>();
  options
      .add_option("input", arguments->sources,
                  "Scans or photos of an open hand, or folders of them")
      ->required();
  add_scale(options, *arguments);
  options
      .add_option("--method", arguments->method,
                  "best: network and outline; paper: Madaras et al., section 4")
      ->check(CLI::IsMember({"best", "paper"}))
      ->capture_default_str();
  options
      .add_option("--view", arguments->view,
                  "Which side of the hand is seen, where no network tells")
      ->check(CLI::IsMember({"palm", "back"}))
      ->capture_default_str();
  options.add_flag("--no-network", arguments->no_network, "Use the outline alone");
  options.add_option("--runner", arguments->runner,
                     "Command of another runner that finds hands (proto/runner.md)");
  options.add_option(
      "--out", arguments->out,
      "hand.bvh or hand.htr: all pictures show one hand, whose median is written; a folder: each "
      "picture on its own, as .bvh.  Beside each a .json and an .annotated.png");
  options.add_flag("--json", arguments->json, "Report as JSON, one document for each picture");
  return [arguments] { return run_scan(*arguments); };
}

}  // namespace chorus::ctl
