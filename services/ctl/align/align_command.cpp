// chorus align REFERENCE.csv [SOURCE]: compares our world with another tracker's, and says or sets
// the origin that makes them one.
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <CLI/CLI.hpp>

#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/client/service_client.h"
#include "common/geometry/rotation.h"
#include "common/importers/text_rows.h"
#include "fusion-server/server/registration_store.h"
#include "fusion-server/wire/registration_file.h"
#include "services/ctl/align/alignment_report.h"
#include "services/ctl/align/reference_file.h"
#include "services/ctl/convert/fused_samples.h"
#include "services/ctl/line/command.h"
#include "services/ctl/line/console.h"
#include "services/ctl/line/number_range.h"
#include "services/ctl/line/server_option.h"
#include "services/ctl/record/recorded_cell.h"

namespace chorus::ctl {
namespace {

using client::ServiceClient;

struct AlignArguments {
  std::string reference;
  std::string source;  ///< Empty: the server at `url`.
  std::string url = client::default_server();
  std::string registration;
  std::string axes = "y-up";
  std::string unit;
  std::string body;
  std::string joint = "Head";
  std::optional<std::uint64_t> person;
  std::optional<double> clock;
  double seconds = 60.0;
  bool marker_offset = false;
  bool full = false;
  bool sensor_axes = false;
  bool apply = false;
  bool json = false;
};

constexpr std::pair<const char*, double> kUnits[] = {
    {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}, {"ft", 0.3048}};

bool is_address(const std::string& source) {
  return source.starts_with("http://") || source.starts_with("https://");
}

ReferenceOptions reading(const AlignArguments& arguments, const std::string& axes) {
  ReferenceOptions options;
  for (const auto& [name, value] : kReferenceAxes) {
    if (name == axes) options.axes = value;
  }
  for (const auto& [name, metres] : kUnits) {
    if (arguments.unit == name) options.metres_per_unit = metres;
  }
  return options;
}

Result<Reference> reference_of(const AlignArguments& arguments, const std::string& axes) {
  constexpr std::uintmax_t kMostBytes = 512U << 20U;
  const auto text = importers::read_bounded(arguments.reference, kMostBytes);
  if (!text) return pass(text);
  return read_reference(*text, arguments.reference, reading(arguments, axes));
}

/// The registration that the source's frames were fused with; none if nothing says so.
Result<std::optional<Registration>> places_of_source(const AlignArguments& arguments) {
  if (!arguments.registration.empty()) {
    auto given = server::load_registration_file(arguments.registration);
    if (!given) return pass(given);
    return std::optional(std::move(*given));
  }
  if (is_address(arguments.source)) {
    const auto server = ServiceClient::of(arguments.source);
    if (!server) return pass(server);
    const auto now = server->get("/registration");
    if (!now) return pass(now);
    if (client::part_at(*now, "sensors").empty()) return std::optional<Registration>();
    auto read = wire::read_registration(now->dump());
    if (!read) return pass(read);
    return std::optional(std::move(*read));
  }
  if (!arguments.source.ends_with(".mcap")) return std::optional<Registration>();
  const auto cell = RecordedCell::open({arguments.source});
  if (!cell) return pass(cell);
  return cell->registration();
}

/// The bodies that are no sensors.
std::vector<std::string> moving_bodies(const Reference& reference,
                                       const std::map<SensorId, SensorMark>& sensors) {
  std::vector<std::string> names;
  for (const auto& [name, samples] : reference.bodies) {
    const auto sensor = SensorId::parse(name);
    if (!sensor || !sensors.contains(*sensor)) names.push_back(name);
  }
  return names;
}

Result<std::string> chosen_body(const AlignArguments& arguments, const Reference& reference,
                                const std::vector<std::string>& moving) {
  if (!arguments.body.empty()) {
    if (reference.bodies.contains(arguments.body)) return arguments.body;
    return fail(
        ErrorCode::NotFound, arguments.reference,
        fmt::format("has no body \"{}\"; it has: {}", arguments.body, fmt::join(moving, ", ")));
  }
  if (moving.size() == 1) return moving.front();
  if (reference.bodies.contains(arguments.joint)) return arguments.joint;
  return fail(ErrorCode::InvalidArgument, arguments.reference,
              fmt::format("has several bodies; name the one on the person with --body: {}",
                          fmt::join(moving, ", ")));
}

alignment::Trace trace_of(const std::vector<ReferenceSample>& samples) {
  alignment::Trace trace;
  for (const ReferenceSample& each : samples) trace.push_back({each.time, each.place, each.turn});
  return trace;
}

/// Left, up and front of a body; none where hips or shoulders are not seen.
std::optional<Eigen::Quaterniond> axes_of(const Skeleton<WorldSpace>& body) {
  Eigen::Vector3d left = Eigen::Vector3d::Zero();
  for (const auto& [one, other] : {std::pair{JointId::HipLeft, JointId::HipRight},
                                   {JointId::ShoulderLeft, JointId::ShoulderRight}}) {
    if (!body[one].seen() || !body[other].seen()) return std::nullopt;
    left += body[one].position - body[other].position;
  }
  constexpr double kNarrowest = 0.05;  // [m]
  if (std::hypot(left.x(), left.z()) < kNarrowest) return std::nullopt;
  // +x is left, and +z sent by this yaw is the front.
  return about_y(std::atan2(-left.z(), left.x()));
}

/// The person whom nearly all frames show, or the one who is asked for.
Result<PersonId> chosen_person(const AlignArguments& arguments, const FusedSamples& samples) {
  if (arguments.person) return PersonId{*arguments.person};
  constexpr double kNearlyAll = 0.8;
  std::map<PersonId, std::size_t> counts;
  for (const auto& sample : samples) ++counts[sample.person];
  std::vector<std::uint64_t> ids;
  for (const auto& [id, count] : counts) {
    if (static_cast<double>(count) >= kNearlyAll * static_cast<double>(samples.size())) return id;
    ids.push_back(id.value);
  }
  return fail(samples.empty() ? ErrorCode::NotFound : ErrorCode::Conflict, arguments.source,
              samples.empty() ? std::string("has nobody in any frame.")
                              : fmt::format("shows several people; name the one with the marker "
                                            "with --person: {}",
                                            fmt::join(ids, ", ")));
}

Result<alignment::Trace> our_trace(const AlignArguments& arguments) {
  if (is_address(arguments.source))
    std::cerr << fmt::format("listening for {} s: walk through the room\n", arguments.seconds);
  const auto listen = std::chrono::milliseconds(std::llround(arguments.seconds * 1e3));
  const auto frames = read_fused_frames(arguments.source, listen);
  if (!frames) return pass(frames);
  for (const std::string& note : frames->notes) std::cerr << "note: " << note << '\n';
  const auto person = chosen_person(arguments, frames->samples);
  if (!person) return pass(person);
  const JointId joint = *joint_named(arguments.joint);
  std::map<double, alignment::TracePoint> points;
  for (const auto& sample : frames->samples) {
    const Joint& seen = sample.skeleton[joint];
    if (sample.person != *person || seen.state != JointState::Tracked) continue;
    const double time = chorus::seconds(sample.instant.time_since_epoch());
    points[time] = {time, seen.position, axes_of(sample.skeleton)};
  }
  alignment::Trace trace;
  for (const auto& [time, point] : points) trace.push_back(point);
  return trace;
}

alignment::AlignmentConfig config_of(const AlignArguments& arguments, const Reference& reference) {
  alignment::AlignmentConfig config;
  config.full = arguments.full;
  config.marker_offset = arguments.marker_offset;
  config.clock_range = arguments.clock;
  constexpr double kUtcRange = 2.0;  // [s]
  if (!arguments.clock && reference.utc) config.clock_range = kUtcRange;
  return config;
}

/// Whether the two would fit if the reference had another unit or other axes than it is said to
/// have.
std::string what_would_fit(const AlignArguments& arguments, const alignment::Trace& ours,
                           const std::string& body) {
  const auto fits = [&](const AlignArguments& other) {
    const auto reference = reference_of(other, other.axes);
    return reference && reference->bodies.contains(body) &&
           alignment::align_traces(ours, trace_of(reference->bodies.at(body)),
                                   config_of(other, *reference));
  };
  AlignArguments other = arguments;
  for (const auto& [name, value] : kReferenceAxes) {
    other.axes = name;
    if (name != arguments.axes && fits(other))
      return fmt::format(".  With --axes {} they fit", name);
  }
  other.axes = arguments.axes;
  for (const auto& [name, metres] : kUnits) {
    other.unit = name;
    if (name != arguments.unit && fits(other))
      return fmt::format(".  With --unit {} they fit", name);
  }
  return {};
}

Result<void> align_walk(const AlignArguments& arguments, const alignment::Trace& ours,
                        const Reference& reference, AlignmentFindings& found) {
  const alignment::Trace theirs = trace_of(reference.bodies.at(found.body));
  auto walk = alignment::align_traces(ours, theirs, config_of(arguments, reference));
  if (!walk) {
    Error error = walk.error();
    error.context = arguments.reference + " beside " + arguments.source;
    if (error.code == ErrorCode::Conflict)
      error.message += what_would_fit(arguments, ours, found.body);
    return tl::unexpected(std::move(error));
  }
  found.utc = reference.utc;
  found.ours_from_reference = walk->ours_from_reference;
  found.walk = std::move(*walk);
  return {};
}

/// The alignment: by the walk where the reference has a body that is no sensor, else by the
/// sensors.
Result<AlignmentFindings> aligned(const AlignArguments& arguments, const Reference& reference,
                                  const std::map<SensorId, SensorMark>& marks,
                                  const std::optional<Registration>& places,
                                  std::optional<alignment::Trace> ours) {
  AlignmentFindings found;
  found.joint = arguments.joint;
  const auto moving = moving_bodies(reference, marks);
  if (moving.empty() || arguments.seconds == 0.0) {
    const auto fit = ours_from_marks(marks, places.value_or(Registration{}));
    if (!fit) return pass(fit);
    found.ours_from_reference = *fit;
    return found;
  }
  const auto body = chosen_body(arguments, reference, moving);
  if (!body) return pass(body);
  found.body = *body;
  if (!ours) {
    auto trace = our_trace(arguments);
    if (!trace) return pass(trace);
    ours = std::move(*trace);
  }
  if (auto done = align_walk(arguments, *ours, reference, found); !done) return pass(done);
  return found;
}

/// The walk of a server is watched before the reference is read: both are recorded at one time.
Result<AlignmentFindings> findings_of(const AlignArguments& arguments,
                                      const std::optional<Registration>& places) {
  std::optional<alignment::Trace> ours;
  if (is_address(arguments.source) && arguments.seconds > 0.0) {
    auto trace = our_trace(arguments);
    if (!trace) return pass(trace);
    ours = std::move(*trace);
  }
  const auto reference = reference_of(arguments, arguments.axes);
  if (!reference) return pass(reference);
  std::map<SensorId, SensorMark> marks;
  if (places) marks = sensor_marks(*reference, *places);
  auto found = aligned(arguments, *reference, marks, places, std::move(ours));
  if (!found || !places) return found;
  found->sensors = deviations(marks, *places, found->ours_from_reference, arguments.sensor_axes);
  const auto master = by_master(marks, *places);
  if (arguments.sensor_axes && master)
    found->from_master = deviations(marks, *places, *master, true);
  return found;
}

/// Conflict unless the server's sensors stand where they stood for the source.
Result<void> same_world(const ServiceClient& server, const AlignArguments& arguments,
                        const std::optional<Registration>& places) {
  constexpr double kSame = mm(1.0);  // of the place, and per metre for the turn
  if (!places)
    return fail(ErrorCode::Conflict, arguments.source,
                "does not say where the sensors stood, so the server's world may be another; name "
                "their places with --registration");
  const auto differs = [&] {
    return fail(ErrorCode::Conflict, arguments.source,
                "the server's sensors do not stand where they stood there, so its world may be "
                "another; without --apply the origin is only said");
  };
  const auto answer = server.get("/registration");
  if (!answer) return pass(answer);
  if (client::part_at(*answer, "sensors").empty()) return differs();
  const auto now = wire::read_registration(answer->dump());
  if (!now) return pass(now);
  for (const auto& [sensor, place] : places->sensors) {
    const auto there = now->sensors.find(sensor);
    if (there == now->sensors.end() ||
        !(there->second.world_from_sensor.matrix() - place.world_from_sensor.matrix())
             .isMuchSmallerThan(kSame, 1.0))
      return differs();
  }
  return {};
}

Result<int> run_align(AlignArguments arguments) {
  if (arguments.source.empty()) arguments.source = arguments.url;
  const auto places = places_of_source(arguments);
  if (!places) return pass(places);
  const auto found = findings_of(arguments, *places);
  if (!found) return pass(found);
  std::cout << (arguments.json ? json_text(alignment_json(*found)) : alignment_text(*found));
  if (!arguments.apply) return kExitOk;
  const auto server =
      ServiceClient::of(is_address(arguments.source) ? arguments.source : arguments.url);
  if (!server) return pass(server);
  if (auto same = same_world(*server, arguments, *places); !same) return pass(same);
  const alignment::FloorPose origin = origin_of(found->ours_from_reference);
  const auto done =
      server->post("/registration/origin",
                   {{"x", origin.x}, {"z", origin.z}, {"yawDegrees", to_deg(origin.yaw)}});
  if (!done) return pass(done);
  std::cerr << "applied: the world has the reference's origin and front now\n";
  return kExitOk;
}

void add_reference_options(CLI::App& options, AlignArguments& arguments) {
  std::vector<std::string> axes;
  for (const auto& [name, value] : kReferenceAxes) axes.emplace_back(name);
  std::vector<std::string> units;
  for (const auto& [name, metres] : kUnits) units.emplace_back(name);
  options
      .add_option(
          "--axes", arguments.axes,
          "Of the reference: y-up (Motive, OpenVR), z-up (VRED, A.R.T.), or unity, which is "
          "left-handed")
      ->check(CLI::IsMember(axes))
      ->capture_default_str();
  options
      .add_option("--unit", arguments.unit, "Of the reference; by default as its file says, or m")
      ->check(CLI::IsMember(units));
  options.add_option("--body", arguments.body, "The body or marker on the person");
  options
      .add_option("--clock", arguments.clock,
                  "Largest difference of the clocks [s]; by default 2 s if both are UTC, else any")
      ->check(number_range(0.1, 86'400.0));
  options.add_flag("--sensor-axes", arguments.sensor_axes,
                   "Bodies that are called as sensors have the sensors' axes: compare turns, too");
}

void add_source_options(CLI::App& options, AlignArguments& arguments) {
  const std::vector<std::string> joints(kJointNames.begin(), kJointNames.end());
  options.add_option("--joint", arguments.joint, "Our joint that carries the marker")
      ->check(CLI::IsMember(joints).description("JOINT"))
      ->capture_default_str();
  options.add_option("--person", arguments.person, "Our person of this id");
  options
      .add_option("--seconds", arguments.seconds,
                  "How long to listen to a server; 0: compare only the sensors")
      ->check(number_range(0.0, 3600.0))
      ->capture_default_str();
  options.add_option("--registration", arguments.registration,
                     "Extrinsics as JSON; by default those of the source");
}

}  // namespace

Run add_align(CLI::App& options) {
  const auto arguments = std::make_shared<AlignArguments>();
  options
      .add_option("reference", arguments->reference,
                  "CSV of the other tracker: Motive's, ours, or columns time,x,y,z")
      ->required();
  options.add_option("source", arguments->source,
                     "Recording (.mcap), NDJSON of chorus fuse, or address of a fusion server; by "
                     "default the server of --url");
  add_reference_options(options, *arguments);
  add_source_options(options, *arguments);
  options.add_flag("--marker-offset", arguments->marker_offset,
                   "Also find where the marker sits beside the joint");
  options.add_flag("--full", arguments->full, "Let the worlds be tilted against each other");
  options.add_flag("--apply", arguments->apply, "Move the server's world there (chorus origin)");
  add_server_option(options, arguments->url, "The fusion server, if the source is none");
  options.add_flag("--json", arguments->json, "Report as JSON");
  return [arguments] { return run_align(*arguments); };
}

}  // namespace chorus::ctl
