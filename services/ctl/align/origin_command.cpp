// chorus origin: sets the origin of the world, by numbers, by marks, or by a person who stands
// there.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "common/alignment/marked_points.h"
#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/client/service_client.h"
#include "common/geometry/rotation.h"
#include "services/ctl/align/person_place.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/operate/no_fusion_server.h"
#include "services/ctl/operate/person_watch.h"
#include "services/ctl/operate/registration_report.h"

namespace chorus::ctl {
namespace {

using client::ServiceClient;

constexpr double kFarthest = 1000.0;  // [m], the limit that the server has

struct OriginArguments {
  std::string url = client::default_server();
  double x = 0.0;
  double z = 0.0;
  double yaw = 0.0;
  bool here = false;
  std::vector<std::string> marks;  ///< "X,Z=X,Z"
  std::vector<std::string> stand;  ///< "X,Z"
  bool points = false;
  bool two = false;
  std::string with = "SpineBase";
  bool set = false;  ///< An origin is given in one of these ways.
  double seconds = 2.0;
  double wait = 60.0;
  bool json = false;
};

/// Where the person stands who is watched for so long, and which way they face.
Result<alignment::FloorPose> watch_stance(const OriginArguments& arguments) {
  std::vector<alignment::FloorPose> seen;
  const auto take = [&](const nlohmann::json& frame) -> Result<bool> {
    const auto stance = person_place(frame);
    if (!stance) return pass(stance);
    const auto place = place_in(frame, arguments.with);
    if (!place) return pass(place);
    seen.push_back({place->x(), place->y(), stance->yaw});
    return false;
  };
  const auto watched = watch_frames(arguments.url, arguments.seconds, take);
  if (!watched) return pass(watched);
  return alignment::steady(seen);
}

/// Where the master stands in the world.  An origin at this place, with this yaw, gives the world
/// that a fresh walk would give.
alignment::FloorPose place_of(const nlohmann::json& sensor) {
  const Eigen::Quaterniond q(client::number_at(sensor, "qw"), client::number_at(sensor, "qx"),
                             client::number_at(sensor, "qy"), client::number_at(sensor, "qz"));
  return {client::number_at(sensor, "x"), client::number_at(sensor, "z"),
          q.coeffs().allFinite() ? yaw_of(normalised_or_identity(q).toRotationMatrix()) : 0.0};
}

/// Where the world begins now, in terms of the master sensor, and how to change that.
std::string origin_report(const nlohmann::json& registration) {
  const std::string master = client::text_at(registration, "master", "");
  const auto& sensors = client::part_at(registration, "sensors");
  if (master.empty() || !sensors.contains(master))
    return "the world has no origin yet: no sensor is registered (chorus register)\n";
  const alignment::FloorPose own = place_of(client::part_at(sensors, master.c_str()));
  const std::string name = printable(master);
  return fmt::format(
      "the world begins where x and z are 0: there the master, {}, stands at x {} m, z {} m, and "
      "looks {} deg away from the front\n"
      "to change it: chorus origin --here, --points, --mark, or --x, --z, --yaw; back to below {}, "
      "in its "
      "direction: chorus origin --x={} --z={} --yaw={}\n",
      name, shown(own.x, 3), shown(own.z, 3), shown(to_deg(own.yaw), 1), name, shown(own.x, 4),
      shown(own.z, 4), shown(to_deg(own.yaw), 2));
}

/// Without an origin to set: shows the present one.
Result<int> show_origin(const ServiceClient& server, const std::string& url, bool json) {
  const auto registration = server.get("/registration");
  if (!registration)
    return tl::unexpected<Error>(no_fusion_server(server, url, registration.error()));
  std::cout << (json ? json_text(*registration) : origin_report(*registration));
  return kExitOk;
}

constexpr const char* kAxesPlaces[] = {"the point that shall be the origin (0, 0)",
                                       "any point straight ahead of it (+z), 2 m away or more",
                                       "any point on the left of who looks from the first to the "
                                       "second (+x); this one only checks"};

/// What the person is asked to stand on, one after another.
std::vector<std::string> places_to_stand(const OriginArguments& arguments) {
  std::vector<std::string> all;
  if (arguments.points) {
    all.assign(std::begin(kAxesPlaces), std::end(kAxesPlaces));
    if (arguments.two) all.pop_back();
    return all;
  }
  for (const std::string& place : arguments.stand) all.push_back("x,z = " + place);
  return all;
}

/// Waits until the person has stood still on the next mark.
Result<Eigen::Vector2d> stood_on(const OriginArguments& arguments,
                                 const std::vector<Eigen::Vector2d>& before) {
  Standstill still(arguments.seconds, before, alignment::kLeastApart);
  std::optional<Eigen::Vector2d> found;
  std::string missing = "nobody has stood still there";
  const auto take = [&](const nlohmann::json& frame) -> Result<bool> {
    const auto place = place_in(frame, arguments.with);
    if (!place) {
      missing = place.error().message;
      still.interrupt();
      return false;
    }
    missing = "nobody has stood still there";
    found = still.take(*place, seconds_of(frame));
    return found.has_value();
  };
  const auto seen = watch_frames(arguments.url, arguments.wait, take);
  if (!seen) return pass(seen);
  if (found) return *found;
  return fail(ErrorCode::NotFound, "origin",
              fmt::format("given up after {} s: {}", arguments.wait, missing));
}

/// Leads the person from mark to mark; nobody needs to be at the keyboard.
Result<std::vector<Eigen::Vector2d>> walk_the_marks(const OriginArguments& arguments) {
  std::vector<Eigen::Vector2d> found;
  const auto places = places_to_stand(arguments);
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::cerr << fmt::format("{} of {}: go to {}, without stopping on the way, and stand still\n",
                             i + 1, places.size(), places[i]);
    const auto place = stood_on(arguments, found);
    if (!place) return pass(place);
    found.push_back(*place);
    std::cerr << fmt::format("\aseen at x {:.3f} m, z {:.3f} m\n", place->x(), place->y());
  }
  return found;
}

/// The marks with numbers: those given, and those that the person is led to.
Result<std::vector<alignment::FloorMark>> marks_of(const OriginArguments& arguments) {
  std::vector<alignment::FloorMark> marks;
  for (const std::string& text : arguments.marks) {
    const auto mark = alignment::read_mark(text);
    if (!mark) return pass(mark);
    marks.push_back(*mark);
  }
  for (const std::string& text : arguments.stand) {
    const auto place = alignment::read_place(text);
    if (!place) return pass(place);
    marks.push_back({Eigen::Vector2d::Zero(), *place});
  }
  return marks;
}

Result<alignment::MarkedOrigin> marked_origin(const OriginArguments& arguments) {
  auto marks = marks_of(arguments);
  if (!marks) return pass(marks);
  if (!arguments.points && arguments.stand.empty()) return alignment::origin_from_marks(*marks);
  const auto stood = walk_the_marks(arguments);
  if (!stood) return pass(stood);
  if (arguments.points)
    return alignment::origin_from_axes(stood->at(0), stood->at(1),
                                       arguments.two ? std::nullopt : std::optional(stood->at(2)));
  const std::size_t given = arguments.marks.size();
  for (std::size_t i = 0; i < stood->size(); ++i) (*marks)[given + i].now = stood->at(i);
  return alignment::origin_from_marks(*marks);
}

/// How well the marks determine the world.
std::string marks_report(const alignment::MarkedOrigin& found) {
  std::string text;
  for (std::size_t i = 0; found.off.size() > 2 && i < found.off.size(); ++i)
    text += fmt::format("mark {}: {:.0f} mm from where it shall be\n", i + 1, to_mm(found.off[i]));
  if (found.off.size() == 2 && found.off[0] > 0.0)
    text += fmt::format("the distance between the marks is off by {:.0f} mm\n",
                        to_mm(found.off[0] + found.off[1]));
  return text + fmt::format(
                    "the marks are {:.2f} m apart: 10 mm at one of them turn the front by "
                    "{:.2f} deg\n",
                    found.apart, to_deg(mm(10) / found.apart));
}

Result<alignment::FloorPose> wanted_origin(const OriginArguments& arguments) {
  if (arguments.here) {
    std::cerr << fmt::format("stand still for {} s, facing the front\n", arguments.seconds);
    return watch_stance(arguments);
  }
  if (!arguments.points && arguments.stand.empty() && arguments.marks.empty())
    return alignment::FloorPose{arguments.x, arguments.z, deg(arguments.yaw)};
  const auto found = marked_origin(arguments);
  if (!found) return pass(found);
  std::cerr << marks_report(*found);
  return found->origin;
}

/// The version of the registration, whose origin can be set at once: nobody shall stand still for a
/// server that is not there, or that would refuse.
Result<double> version_to_change(const ServiceClient& server, const std::string& url) {
  const auto registration = server.get("/registration");
  if (!registration)
    return tl::unexpected<Error>(no_fusion_server(server, url, registration.error()));
  const auto state = client::text_at(client::part_at(*registration, "session"), "state", "");
  if (state == "collecting" || state == "solving")
    return fail(ErrorCode::Conflict, "origin",
                "a registration session is running; wait for its end, or cancel it: chorus "
                "register --cancel");
  const double version = client::number_at(*registration, "version");
  return std::isfinite(version) ? version : 0.0;
}

Result<int> set_origin(const ServiceClient& server, const alignment::FloorPose& origin, bool json) {
  const auto registration =
      server.post("/registration/origin",
                  {{"x", origin.x}, {"z", origin.z}, {"yawDegrees", to_deg(origin.yaw)}});
  if (!registration) return pass(registration);
  if (json) {
    std::cout << json_text(*registration);
    return kExitOk;
  }
  std::cout << fmt::format(
                   "the world begins at what was x {:.3f} m, z {:.3f} m; its front is what "
                   "was {:.1f} deg\n",
                   origin.x, origin.z, to_deg(origin.yaw))
            << registration_report(*registration);
  return kExitOk;
}

Result<int> run_origin(const OriginArguments& arguments) {
  const auto server = ServiceClient::of(arguments.url);
  if (!server) return pass(server);
  if (!arguments.set) return show_origin(*server, arguments.url, arguments.json);
  const bool watches = arguments.here || arguments.points || !arguments.stand.empty();
  std::optional<double> world;
  if (watches) {
    const auto ready = version_to_change(*server, arguments.url);
    if (!ready) return pass(ready);
    world = *ready;
  }
  const auto origin = wanted_origin(arguments);
  if (!origin) return pass(origin);
  if (world) {
    const auto now = version_to_change(*server, arguments.url);
    if (!now) return pass(now);
    if (*now != *world)
      return fail(ErrorCode::Conflict, "origin",
                  "the registration was changed while you stood on the marks, so they are of "
                  "another world; nothing was changed now, begin again");
  }
  return set_origin(*server, *origin, arguments.json);
}

/// The options that only matter while a person is watched.
std::vector<CLI::Option*> add_watch_options(CLI::App& options, OriginArguments& arguments) {
  std::vector<std::string> names(kJointNames.begin(), kJointNames.end());
  names.emplace_back(kFeet);
  auto* with =
      options
          .add_option("--with", arguments.with, "What of the person is above a mark: a joint, feet")
          ->check(CLI::IsMember(names).description("JOINT"))
          ->capture_default_str();
  auto* seconds =
      options.add_option("--seconds", arguments.seconds, "How long the person stands still [s]")
          ->check(number_range(0.5, 30.0))
          ->capture_default_str();
  auto* wait = options.add_option("--wait", arguments.wait, "How long each mark is waited for [s]")
                   ->check(number_range(0.5, 3600.0))
                   ->capture_default_str();
  return {with, seconds, wait};
}

/// What the options do not check one by one.
void check_marks(const OriginArguments& arguments, bool about_watching) {
  const auto marks = marks_of(arguments);
  if (!marks) throw CLI::ValidationError("--mark, --stand", marks.error().message);
  if (marks->size() == 1) throw CLI::ValidationError("--mark, --stand", "two or more are needed");
  if (about_watching && !arguments.here && !arguments.points && arguments.stand.empty())
    throw CLI::ValidationError("--with, --seconds, --wait", "nobody is watched by these options");
}

/// Each way to give an origin; the options of one way exclude those of the others.
using Ways = std::vector<std::vector<CLI::Option*>>;

std::vector<CLI::Option*> add_numbers(CLI::App& options, OriginArguments& arguments) {
  const auto place = number_range(-kFarthest, kFarthest);
  return {options.add_option("--x", arguments.x, "Of the new origin, in the world as it is [m]")
              ->check(place),
          options.add_option("--z", arguments.z, "Likewise [m]")->check(place),
          options
              .add_option("--yaw", arguments.yaw,
                          "Where the new front is, about +y from the front there is [deg]")
              ->check(number_range(-360.0, 360.0))};
}

std::vector<CLI::Option*> add_marks(CLI::App& options, OriginArguments& arguments) {
  return {options.add_option("--mark", arguments.marks,
                             "A point X,Z of the world as it is, and where it shall be: "
                             "--mark=1.2,3.4=0,0; two or more of them"),
          options.add_option("--stand", arguments.stand,
                             "A point of the world to be on which one person stands: "
                             "--stand=0,0; two or more, in this order")};
}

std::vector<CLI::Option*> add_points(CLI::App& options, OriginArguments& arguments) {
  auto* points = options.add_flag("--points", arguments.points,
                                  "One person stands on the origin, then straight ahead of it, "
                                  "then on the left");
  options.add_flag("--two", arguments.two, "Without the third point, which checks")->needs(points);
  return {points};
}

void exclude_one_another(const Ways& ways) {
  for (std::size_t i = 0; i < ways.size(); ++i) {
    for (std::size_t k = i + 1; k < ways.size(); ++k) {
      for (CLI::Option* one : ways[i]) {
        for (CLI::Option* other : ways[k]) one->excludes(other);
      }
    }
  }
}

bool any_given(const std::vector<CLI::Option*>& options) {
  return std::ranges::any_of(options, [](const CLI::Option* each) { return each->count() > 0; });
}

}  // namespace

Run add_origin(CLI::App& options) {
  const auto arguments = std::make_shared<OriginArguments>();
  add_server_option(options, arguments->url, "The fusion server", "url,--url");
  auto* here = options.add_flag("--here", arguments->here,
                                "Where one person stands, facing what shall be the front");
  const Ways ways{add_numbers(options, *arguments),
                  {here},
                  add_points(options, *arguments),
                  add_marks(options, *arguments)};
  exclude_one_another(ways);
  const auto watching = add_watch_options(options, *arguments);
  options.add_flag("--json", arguments->json, "Report as JSON");
  options.callback([=] {
    arguments->set = std::ranges::any_of(ways, any_given);
    check_marks(*arguments, any_given(watching));
  });
  return [arguments] { return run_origin(*arguments); };
}

}  // namespace chorus::ctl
