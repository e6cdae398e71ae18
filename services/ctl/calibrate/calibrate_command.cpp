// chorus calibrate camera: measures the lens of a camera from pictures of a board, or writes one
// from known data.
#include <filesystem>
#include <iostream>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/file.h"
#include "common/base/units.h"
#include "common/calibration/board_sheet.h"
#include "common/calibration/exif.h"
#include "common/calibration/report.h"
#include "common/calibration/verdict.h"
#include "services/ctl/calibrate/board_options.h"
#include "services/ctl/calibrate/board_pictures.h"
#include "services/ctl/calibrate/calibration_report.h"
#include "services/ctl/calibrate/place_command.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"
#include "services/sensor/device/camera/picture.h"

namespace chorus::ctl {
namespace {

using calibration::Board;
using calibration::Calibration;
using calibration::PictureSize;

constexpr std::size_t kMostViews = 40;  // More views take longer and hardly improve the lens.
constexpr std::uintmax_t kMaxPhoto = 1u << 28;
// Relative standard deviation of a focal length from a photo: Exif rounds to millimetres, and
// videos are cropped.
constexpr double kPhotoSigma = 0.04;

struct CalibrateArguments {
  std::vector<std::string> sources;
  BoardOptions board;
  bool fisheye = false;
  std::string print_board;
  bool letter = false;
  double fov_deg = 0.0;  ///< 0: not stated.
  double fov_sigma_deg = 3.0;
  std::string size;
  std::string photo;
  double seconds = 60.0;
  std::string out = "-";
  bool json = false;
};

Result<int> print_board(const CalibrateArguments& arguments) {
  const auto board = board_of(arguments.board);
  if (!board) return pass(board);
  const bool pdf = arguments.print_board.ends_with(".pdf");
  if (!pdf && !arguments.print_board.ends_with(".png"))
    return fail(ErrorCode::InvalidArgument, "--print-board", "must end in .pdf or .png");
  const auto sheet =
      pdf ? calibration::board_pdf(*board, arguments.letter) : calibration::board_png(*board);
  if (!sheet) return pass(sheet);
  if (const auto ok = write_text(arguments.print_board, *sheet); !ok) return pass(ok);
  std::cout << fmt::format(
      "wrote {}: {}\nPrint it at 100 %, measure a square, glue the sheet on something flat.\n",
      arguments.print_board, description(*board));
  return kExitOk;
}

/// Writes a lens from known data, without measuring.
Result<int> write_known(const CalibrateArguments& arguments, const camera::Lens& lens) {
  const std::string text = calibration::intrinsics_json(lens.camera, lens.focal_sigma);
  if (const auto ok = write_text(arguments.out, text); !ok) return pass(ok);
  std::cerr << fmt::format(
      "a focal length of {:.0f} px, give or take {:.1f} %, a centred lens without distortion: rays "
      "at the edge of the picture may be off by degrees, which their covariances say\n",
      lens.camera.fx, 100.0 * lens.focal_sigma);
  return kExitOk;
}

Result<int> from_field_of_view(const CalibrateArguments& arguments) {
  if (arguments.size.empty())
    return fail(ErrorCode::InvalidArgument, "--size",
                "is missing: that of the camera's pictures, as 1280x720");
  const auto [width, height] = pair_in(arguments.size).value();
  camera::CameraSettings settings;
  settings.fov = deg(arguments.fov_deg);
  settings.fov_sigma = deg(arguments.fov_sigma_deg);
  const auto lens = lens_for(settings, {width, height});
  if (!lens) return pass(lens);
  return write_known(arguments, *lens);
}

Result<int> from_photo(const CalibrateArguments& arguments) {
  const auto bytes = read_file(arguments.photo, kMaxPhoto);
  if (!bytes) return pass(bytes);
  const auto picture = camera::read_picture(arguments.photo);
  if (!picture) return pass(picture);
  const auto focal = calibration::focal_on_35mm_film(*bytes);
  if (!focal)
    return fail(ErrorCode::NotFound, arguments.photo,
                "does not tell the lens (Exif FocalLengthIn35mmFilm); state --fov and --size");
  auto [width, height] = picture->size;
  camera::Lens lens;
  lens.camera = {width, height, 0, 0, 0.5 * (width - 1), 0.5 * (height - 1), {}};
  lens.camera.fx = lens.camera.fy = calibration::pixels_of_35mm(*focal, width, height);
  lens.focal_sigma = kPhotoSigma;
  return write_known(arguments, lens);
}

std::string coverage_file(const std::string& out) {
  return std::filesystem::path(out).replace_extension(".coverage.png").string();
}

/// Writes the coverage picture even when the views are refused, because it shows where views are
/// missing.
Result<void> write_coverage(const CalibrateArguments& arguments, const Calibration& calibration,
                            PictureSize size) {
  if (arguments.out == "-" || calibration.views.empty()) return {};
  const auto picture = calibration::coverage_png(calibration.views, size);
  if (!picture) return pass(picture);
  return write_text(coverage_file(arguments.out), *picture);
}

/// Said before anybody moves a board before the camera for a minute.
Result<void> has_folder(const std::string& out) {
  const std::filesystem::path folder = std::filesystem::path(out).parent_path();
  std::error_code ignored;
  if (folder.empty() || std::filesystem::is_directory(folder, ignored)) return {};
  return fail(ErrorCode::NotFound, folder.string(),
              "there is no such folder for --out; make it first");
}

struct Judged {
  Calibration calibration;
  std::vector<std::string> weaknesses;
};

Result<Judged> judged(const BoardViews& found, LensModel model) {
  const auto views = calibration::varied_views(found.views, found.size, kMostViews);
  Judged out;
  auto solved = calibration::calibrate(views, found.size, model);
  if (solved) {
    out.calibration = std::move(*solved);
    out.weaknesses = weaknesses(out.calibration);
    return out;
  }
  for (const auto& view : views) out.calibration.views.push_back({view});
  out.weaknesses = missing_views(views, found.size);
  if (out.weaknesses.empty()) return pass(solved);
  return out;
}

Result<BoardViews> look(const CalibrateArguments& arguments, const Board& board) {
  Progress progress(std::cerr, on_terminal(), "looking for the board");
  auto found = look_for_board(
      {arguments.sources, board, arguments.seconds, [&](double share, std::string_view remark) {
         progress.show(share, on_terminal() ? remark : std::string_view());
       }});
  progress.finish();
  return found;
}

void report(const CalibrateArguments& arguments, const Board& board, const BoardViews& found,
            const Judged& outcome) {
  if (arguments.json) {
    std::cout << json_text(calibration_json(outcome.calibration, found, outcome.weaknesses));
    return;
  }
  (arguments.out == "-" ? std::cerr : std::cout)
      << description(board) << "\n"
      << calibration_text(outcome.calibration, found, outcome.weaknesses);
}

Result<int> from_board(const CalibrateArguments& arguments) {
  const auto board = board_of(arguments.board);
  if (!board) return pass(board);
  if (arguments.json && arguments.out == "-")
    return fail(ErrorCode::InvalidArgument, "--json", "needs --out FILE for the lens");
  if (auto ok = has_folder(arguments.out); !ok) return pass(ok);
  const auto found = look(arguments, *board);
  if (!found) return pass(found);
  const auto outcome = judged(*found, arguments.fisheye ? LensModel::Fisheye : LensModel::Brown);
  if (!outcome) return pass(outcome);
  const Calibration& calibration = outcome->calibration;
  if (auto ok = write_coverage(arguments, calibration, found->size); !ok) return pass(ok);
  report(arguments, *board, *found, *outcome);
  if (!outcome->weaknesses.empty()) return kExitFailed;
  const std::string lens =
      calibration::intrinsics_json(calibration.intrinsics, calibration.focal_sigma());
  if (const auto ok = write_text(arguments.out, lens); !ok) return pass(ok);
  if (!arguments.json && arguments.out != "-")
    std::cout << fmt::format("wrote {} and {}\n", arguments.out, coverage_file(arguments.out));
  return kExitOk;
}

Result<int> run_calibrate(const CalibrateArguments& arguments) {
  if (!arguments.print_board.empty()) return print_board(arguments);
  if (const auto ok = may_create(arguments.out); !ok) return pass(ok);
  if (arguments.fov_deg > 0.0) return from_field_of_view(arguments);
  if (!arguments.photo.empty()) return from_photo(arguments);
  if (!arguments.sources.empty()) return from_board(arguments);
  return fail(ErrorCode::InvalidArgument, "input",
              "is missing: pictures of a board (photos, a folder, a video, /dev/video0); or say "
              "--print-board, --fov or --photo");
}

void add_other_ways(CLI::App& options, CalibrateArguments& arguments) {
  options.add_option("--print-board", arguments.print_board,
                     "Only writes the board to print, in its real size: a .pdf or .png");
  options.add_flag("--letter", arguments.letter, "Paper of 8.5 x 11 inches instead of A4 to A0");
  options
      .add_option("--fov", arguments.fov_deg,
                  "Without pictures: the field of view across the longer side [deg], from the "
                  "data sheet")
      ->check(number_range(5.0, 150.0));
  options
      .add_option("--fov-sigma", arguments.fov_sigma_deg,
                  "How sure that is, as a standard deviation [deg]")
      ->check(number_range(0.1, 30.0))
      ->capture_default_str();
  options.add_option("--size", arguments.size, "Of the camera's pictures, for --fov: 1280x720")
      ->check(CLI::Validator(check_pair, "WxH"));
  options.add_option("--photo", arguments.photo,
                     "Without a board: the focal length that this photo states (Exif)");
}

}  // namespace

Run add_calibrate(CLI::App& options) {
  const auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* const lens = options.add_subcommand("camera", "Focal length, centre and distortion");
  CLI::App* const place = options.add_subcommand("place", "Where a camera stands");
  const Run run_place = add_calibrate_place(*place);
  options.require_subcommand(1);
  lens->add_option("input", arguments->sources,
                   "Pictures of the board: photos, folders, videos, or /dev/video0");
  add_board_options(*lens, arguments->board);
  lens->add_flag("--fisheye", arguments->fisheye,
                 "The lens is a fisheye: Kannala and Brandt's model instead of Brown's");
  add_other_ways(*lens, *arguments);
  lens->add_option("--seconds", arguments->seconds, "How long a camera or stream is watched")
      ->check(number_range(5.0, 600.0))
      ->capture_default_str();
  lens->add_option("--out", arguments->out,
                   "File for the lens: device.camera.intrinsics, and --intrinsics of import; -: "
                   "standard output.  Where the board was is drawn in FILE.coverage.png")
      ->capture_default_str();
  lens->add_flag("--json", arguments->json, "Report as JSON, with the error of each picture");
  return [arguments, place, run_place] {
    return place->parsed() ? run_place() : run_calibrate(*arguments);
  };
}

}  // namespace chorus::ctl
