#include "services/ctl/calibrate/place_command.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/base/file.h"
#include "common/base/parse.h"
#include "common/base/units.h"
#include "common/calibration/place.h"
#include "common/time/clock.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/calibrate/board_options.h"
#include "services/ctl/calibrate/board_pictures.h"
#include "services/ctl/calibrate/lens_file.h"
#include "services/ctl/calibrate/place_report.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

using calibration::Corner;
using calibration::PlaceQuestion;
using calibration::View;

constexpr std::uintmax_t kMaxPlaces = 1u << 22;
constexpr std::size_t kMostSights = 12;  // More take longer and hardly improve the place.
constexpr double kMarkSigma = 1.5;       // Of a mark that a person pointed at [px].

struct PlaceArguments {
  std::vector<std::string> sources;
  BoardOptions board;
  std::string lens;
  bool stands = false;
  double board_height_mm = 0.0;
  std::vector<std::string> marks;
  double height_m = 0.0;  ///< 0: not measured.
  double roll_deg = 30.0;
  std::string area = "6x6";
  double most_mm = 50.0;
  std::string sensor = "cam01";
  std::string with;
  double seconds = 10.0;
  std::string out = "-";
  bool json = false;
};

/// "u,v=x,z": a pixel and a place on the floor, as a corner of a lying board.
Result<Corner> mark_in(const std::string& given) {
  std::string_view text = given;
  std::array<double, 4> numbers{};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    constexpr std::string_view kBetween = ",=,";
    const auto number = take_number<double>(text);
    const bool more = i < kBetween.size();
    if (!number || !std::isfinite(*number) || (more && !text.starts_with(kBetween[i])) ||
        (!more && !text.empty()))
      return fail(ErrorCode::InvalidArgument, "--mark " + given,
                  "must be u,v=x,z: a pixel, and the place of what it shows on the floor [m]");
    numbers[i] = *number;
    if (more) text.remove_prefix(1);
  }
  return Corner{{numbers[2], -numbers[3]}, {numbers[0], numbers[1]}};
}

Result<View> marks_in(const std::vector<std::string>& given) {
  View view{"the marks", {}};
  for (const std::string& text : given) {
    const auto mark = mark_in(text);
    if (!mark) return pass(mark);
    view.corners.push_back(*mark);
  }
  return view;
}

Result<BoardViews> find_board(const PlaceArguments& arguments) {
  const auto board = board_of(arguments.board);
  if (!board) return pass(board);
  Progress progress(std::cerr, on_terminal(), "looking for the board");
  auto found = look_for_board(
      {arguments.sources, *board, arguments.seconds, [&](double share, std::string_view remark) {
         progress.show(share, on_terminal() ? remark : std::string_view());
       }});
  progress.finish();
  if (found && found->views.empty())
    return fail(ErrorCode::NotFound, arguments.sources.front(),
                fmt::format("no board of {} in {} pictures; are --squares and --board as printed, "
                            "and is enough of it in view?",
                            description(*board), found->pictures));
  return found;
}

struct Asked {
  PlaceQuestion question;
  std::vector<std::string> notes;
};

Result<Asked> question_of(const PlaceArguments& arguments) {
  const auto settings = read_lens_file(arguments.lens);
  if (!settings) return pass(settings);
  camera::Size size{settings->intrinsics->width, settings->intrinsics->height};
  Asked asked;
  PlaceQuestion& question = asked.question;
  if (!arguments.marks.empty()) {
    const auto marks = marks_in(arguments.marks);
    if (!marks) return pass(marks);
    question.sights = {*marks};
    question.pixel_sigma = kMarkSigma;
  } else {
    auto found = find_board(arguments);
    if (!found) return pass(found);
    size = {found->size.width, found->size.height};
    question.sights = calibration::varied_views(found->views, found->size, kMostSights);
    asked.notes = std::move(found->notes);
    if (arguments.stands) question.stance = calibration::BoardStance::Stands;
  }
  const auto lens = camera::lens_for(*settings, size);
  if (!lens) return pass(lens);
  question.lens = lens->camera;
  question.focal_sigma = lens->focal_sigma;
  question.board_height = mm(arguments.board_height_mm);
  question.largest_roll = deg(arguments.roll_deg);
  if (arguments.height_m > 0.0) question.height = arguments.height_m;
  return asked;
}

Result<void> write_places(const PlaceArguments& arguments, const calibration::CameraPlace& place) {
  const auto sensor = SensorId::parse(arguments.sensor);
  if (!sensor) return pass(sensor);
  Registration places;
  if (!arguments.with.empty()) {
    const auto text = read_file(arguments.with, kMaxPlaces);
    if (!text) return pass(text);
    auto known = wire::read_registration(*text);
    if (!known) return pass(known);
    places = std::move(*known);
  }
  if (places.master.str().empty()) places.master = *sensor;
  places.solved = SystemClock().now();
  places.verdict = Verdict::Good;
  Extrinsics& one = places.sensors[*sensor];
  one.world_from_sensor = place.world_from_sensor;
  one.chain = {places.master};
  if (*sensor != places.master) one.chain.push_back(*sensor);
  one.error = std::sqrt(place.covariance.bottomRightCorner<3, 3>().trace());
  one.covariance = place.covariance;
  return write_text(arguments.out, wire::write_registration(places));
}

Result<PlaceOutcome> solve(const PlaceArguments& arguments, const Asked& asked) {
  const auto place = calibration::place_of(asked.question);
  if (!place) return pass(place);
  const auto [across, deep] = pair_in(arguments.area).value();  // checked while parsing
  PlaceOutcome outcome;
  outcome.sensor = arguments.sensor;
  outcome.place = *place;
  outcome.errors = calibration::errors_in(*place, asked.question.lens,
                                          {static_cast<double>(across), static_cast<double>(deep)});
  outcome.weaknesses = calibration::place_weaknesses(outcome.errors, asked.question,
                                                     {.error = mm(arguments.most_mm)});
  outcome.notes = asked.notes;
  return outcome;
}

Result<int> run_place(const PlaceArguments& arguments) {
  if (arguments.sources.empty() == arguments.marks.empty())
    return fail(ErrorCode::InvalidArgument, "input",
                "give either pictures of a board (photos, a folder, a video, /dev/video0), or "
                "--mark u,v=x,z at least four times");
  if (arguments.json && arguments.out == "-")
    return fail(ErrorCode::InvalidArgument, "--json", "needs --out FILE for the place");
  if (const auto ok = may_create(arguments.out); !ok) return pass(ok);
  const auto asked = question_of(arguments);
  if (!asked) return pass(asked);
  const auto outcome = solve(arguments, *asked);
  if (!outcome) return pass(outcome);
  if (arguments.json) {
    std::cout << json_text(place_json(*outcome));
  } else {
    (arguments.out == "-" ? std::cerr : std::cout) << place_text(*outcome);
  }
  if (!outcome->weaknesses.empty()) return kExitFailed;
  if (const auto ok = write_places(arguments, outcome->place); !ok) return pass(ok);
  return kExitOk;
}

void add_geometry(CLI::App& options, PlaceArguments& arguments) {
  options.add_flag("--stands", arguments.stands,
                   "The board stands upright; otherwise it lies on the floor");
  options
      .add_option("--board-height-mm", arguments.board_height_mm,
                  "Of a standing board's lower edge above the floor")
      ->check(number_range(0.0, 3000.0))
      ->capture_default_str();
  options.add_option("--mark", arguments.marks,
                     "Instead of a board: u,v=x,z, a pixel and the place on the floor that it "
                     "shows [m]; at least four");
  options.add_option("--height-m", arguments.height_m, "The camera's height, if it was measured")
      ->check(number_range(0.1, 20.0));
  options
      .add_option("--roll-deg", arguments.roll_deg,
                  "How far the camera may be turned about its line of sight")
      ->check(number_range(1.0, 180.0))
      ->capture_default_str();
  options.add_option("--area", arguments.area, "Where people will be, around the origin [m]")
      ->check(CLI::Validator(check_pair, "WxD"))
      ->capture_default_str();
  options
      .add_option("--most-mm", arguments.most_mm,
                  "Refuse a place that misplaces people by more than this")
      ->check(number_range(1.0, 1000.0))
      ->capture_default_str();
}

}  // namespace

Run add_calibrate_place(CLI::App& options) {
  const auto arguments = std::make_shared<PlaceArguments>();
  options.add_option("input", arguments->sources,
                     "Pictures of the board: photos, folders, videos, or /dev/video0");
  options
      .add_option("--intrinsics", arguments->lens,
                  "The lens, as `chorus calibrate camera` writes it")
      ->required();
  add_board_options(options, arguments->board);
  add_geometry(options, *arguments);
  options.add_option("--sensor", arguments->sensor, "The camera's name")->capture_default_str();
  options.add_option("--with", arguments->with, "Add the camera to the places in this file");
  options.add_option("--seconds", arguments->seconds, "How long a camera or stream is watched")
      ->check(number_range(1.0, 600.0))
      ->capture_default_str();
  options
      .add_option("--out", arguments->out,
                  "File for the place, in the form of registration.file; -: standard output")
      ->capture_default_str();
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments] { return run_place(*arguments); };
}

}  // namespace chorus::ctl
