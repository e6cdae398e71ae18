#include "common/importers/own_files.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "common/base/nearest.h"
#include "common/base/units.h"
#include "common/body/bones.h"
#include "common/geometry/rotation.h"
#include "common/importers/instants.h"
#include "common/importers/table.h"
#include "common/importers/text_recording.h"
#include "common/layout/layout.h"
#include "common/resource/frame_resource.h"

namespace chorus::importers {
namespace {

constexpr std::array<std::string_view, 3> kStates{"NotTracked", "Inferred", "Tracked"};
constexpr std::array<std::string_view, 3> kPosition{"x_m", "y_m", "z_m"};
constexpr std::array<std::string_view, 4> kTurn{"qx", "qy", "qz", "qw"};

Result<Timestamp> instant_of(const Table& row, const ImportOptions& options) {
  if (!row.field("utc").empty()) {
    const auto utc = parse_iso8601(row.field("utc"));
    if (!utc) return row.wrong("utc", "is not a UTC time such as 2026-11-22T07:30:00.033Z");
    return *utc;
  }
  const auto since = row.number("time_s", kMaxSeconds);
  if (!since) return pass(since);
  if (!*since) return row.wrong("time_s", "is missing, and so is utc");
  return options.start + from_seconds(**since);
}

/// The numbers in these columns; none if one of them is missing.
template <std::size_t Count>
Result<std::optional<std::array<double, Count>>> numbers(
    const Table& row, const std::array<std::string_view, Count>& columns, double bound) {
  std::array<double, Count> values{};
  std::size_t given = 0;
  for (std::size_t i = 0; i < Count; ++i) {
    const auto value = row.number(columns[i], bound);
    if (!value) return pass(value);
    if (!*value) continue;
    values[i] = **value;
    ++given;
  }
  if (given < Count) return std::nullopt;
  return values;
}

/// The covariance from the column sd_mm, equal along all axes; unknown if the field is empty or 0.
Result<Covariance> covariance_of(const Table& row) {
  constexpr double kWidest = 1e4;  // [mm]
  const auto deviation = row.number("sd_mm", kWidest);
  if (!deviation) return pass(deviation);
  if (!*deviation || **deviation == 0.0) return Covariance{};  // Nobody is that exact.
  if (**deviation < 0) return row.wrong("sd_mm", "is below 0");
  const double sigma = mm(**deviation);
  return Covariance(Eigen::Matrix3d(sigma * sigma * Eigen::Matrix3d::Identity()));
}

Result<Joint> joint_of(const Table& row, double metres_per_unit) {
  Joint joint;
  const auto place = numbers(row, kPosition, kMaxImported / metres_per_unit);
  if (!place) return pass(place);
  if (!*place) return joint;
  joint.position = metres_per_unit * Eigen::Vector3d((*place)->data());
  joint.state = JointState::Tracked;
  if (const std::string_view state = row.field("state"); !state.empty()) {
    const auto* const known = std::ranges::find(kStates, state);
    if (known == kStates.end())
      return row.wrong("state", "is none of NotTracked, Inferred and Tracked");
    joint.state = static_cast<JointState>(known - kStates.begin());
  }
  const auto covariance = covariance_of(row);
  if (!covariance) return pass(covariance);
  joint.covariance = *covariance;
  const auto turn = numbers(row, kTurn, 1.01);
  if (!turn) return pass(turn);
  if (!*turn) return joint;
  joint.orientation = Eigen::Quaterniond((**turn)[3], (**turn)[0], (**turn)[1], (**turn)[2]);
  if (std::abs(joint.orientation.norm() - 1.0) > 0.01)
    return row.wrong("qx", "and its companions are no rotation: their length is not 1");
  joint.orientation.normalize();
  return joint;
}

std::string no_joint(std::string_view word) {
  const std::vector<std::string> names(kJointNames.begin(), kJointNames.end());
  const std::string meant = nearest(word, names);
  return meant.empty()
             ? "is no joint of ours, such as ShoulderLeft; docs/terminology.md lists all 25"
             : fmt::format("is no joint of ours; did you mean {}?", meant);
}

Result<void> check_columns(const LineReader& lines, const Table& table) {
  for (const std::string_view needed : {"joint", "x_m", "y_m", "z_m"}) {
    if (!table.has(needed))
      return lines.malformed(
          fmt::format("names no column \"{}\"; joint, x_m, y_m, z_m and utc or "
                      "time_s are needed.",
                      needed));
  }
  if (!table.has("utc") && !table.has("time_s"))
    return lines.malformed("names neither a column \"utc\" nor \"time_s\".");
  return {};
}

Result<void> note_unseen(std::size_t unseen, record::FrameRecording& recording) {
  if (unseen > 0)
    recording.notes["missing"] = fmt::format("{} joints are marked as not seen", unseen);
  return {};
}

Result<void> read_joint_rows(LineReader& lines, const ImportOptions& options,
                             record::FrameRecording& recording) {
  auto table = Table::open(lines);
  if (!table) return pass(table);
  if (auto ok = check_columns(lines, *table); !ok) return ok;
  recording.notes["time"] = table->has("utc")
                                ? "UTC as recorded"
                                : "seconds of the file count from " + to_iso8601(options.start);
  Instants instants(options, recording);
  std::size_t unseen = 0;
  while (true) {
    const auto more = table->next();
    if (!more) return pass(more);
    if (!*more) return note_unseen(unseen, recording);
    const auto captured = instant_of(*table, options);
    if (!captured) return pass(captured);
    const auto person = table->natural("person", 1);
    if (!person) return pass(person);
    const auto id = joint_named(table->field("joint"));
    if (!id) return table->wrong("joint", no_joint(table->field("joint")));
    const auto joint = joint_of(*table, options.metres_per_unit.value_or(1.0));
    if (!joint) return pass(joint);
    if (auto ok = instants.reach(lines, *captured); !ok) return ok;
    if (!joint->given()) ++unseen;
    if (!joint->given()) continue;  // A missing joint has a row too.
    const auto body = instants.body(lines, *captured, BodyId{*person});
    if (!body) return pass(body);
    if ((*body)->skeleton[*id].given())
      return table->wrong("joint", "is there twice at one instant; is a column person missing?");
    (*body)->skeleton[*id] = *joint;
  }
}

Result<void> read_ndjson_lines(LineReader& lines, const ImportOptions& options,
                               record::FrameRecording& recording) {
  recording.notes["time"] = "UTC as recorded";
  while (const auto line = lines.next_filled()) {
    const auto document = resource::read_frame(*line, resource::Format::Json);
    if (!document) return lines.malformed(to_string(document.error()));
    auto& frames = recording.frames;
    if (!frames.empty() && document->captured <= frames.back().captured)
      return lines.malformed("was captured before the line above it, or at the same time.");
    if (frames.size() == options.limits.max_frames)
      return lines.malformed(fmt::format("is beyond the {} frames read at most.", frames.size()));
    SensorFrame frame = to_sensor_frame(*document, recording.sensor, document->captured);
    frame.sequence = frames.size() + 1;
    frame.floor = options.floor;
    frames.push_back(std::move(frame));
  }
  return {};
}

constexpr double kAzureUnit = 1e-3;  // [m]
constexpr std::string_view kAzureLayout = "azure_kinect_32";

/// Reads a landmark, which the file states in millimetres along camera axes (x right, y down), as
/// one in sensor space.
Result<layout::Landmark> azure_landmark(const Table& row, const std::string& name,
                                        const layout::Layout& layout, double metres_per_unit) {
  const double farthest = kMaxImported / metres_per_unit;
  layout::Landmark landmark;
  const auto confidence = row.number(name + " (c)", 3.0);
  if (!confidence) return pass(confidence);
  const std::string x_name = name + " (x)";
  const std::string y_name = name + " (y)";
  const std::string z_name = name + " (z)";
  const auto place = numbers<3>(row, {x_name, y_name, z_name}, farthest);
  if (!place) return pass(place);
  if (!*place || !*confidence) return landmark;
  const auto [x, y, z] = **place;
  landmark.position = Eigen::Vector3d(-x, -y, z) * metres_per_unit;
  landmark.state = layout::state_of(0.5 * **confidence, layout.tracked_from, layout.inferred_from);
  return landmark;
}

Result<Skeleton<SensorSpace>> azure_body(const Table& row, const layout::Layout& layout,
                                         double metres_per_unit) {
  std::vector<layout::Landmark> landmarks;
  for (const std::string_view name : layout.landmarks) {
    const auto landmark = azure_landmark(row, std::string(name), layout, metres_per_unit);
    if (!landmark) return pass(landmark);
    landmarks.push_back(*landmark);
  }
  return Skeleton<SensorSpace>{layout::joints_of(layout, landmarks)};
}

Result<void> read_azure_rows(LineReader& lines, const ImportOptions& options,
                             record::FrameRecording& recording) {
  auto table = Table::open(lines);
  if (!table) return pass(table);
  if (!table->has("timestamp") || !table->has("PELVIS (x)"))
    return lines.malformed("names no columns \"timestamp\" and \"PELVIS (x)\".");
  const auto layout = layout::find_layout(kAzureLayout);
  if (!layout) return pass(layout);
  Instants instants(options, recording);
  std::optional<std::uint64_t> first;  // [us]
  while (true) {
    const auto more = table->next();
    if (!more) return pass(more);
    if (!*more) return {};
    const auto stamp = table->natural("timestamp", 0);
    if (!stamp) return pass(stamp);
    const auto person = table->natural("body_idx", 1);
    if (!person) return pass(person);
    if (!first) first = *stamp;
    if (*stamp < *first || static_cast<double>(*stamp - *first) > 1e6 * kMaxSeconds)
      return table->wrong("timestamp", "goes back, or jumps by more than a week");
    auto skeleton = azure_body(*table, **layout, options.metres_per_unit.value_or(kAzureUnit));
    if (!skeleton) return pass(skeleton);
    const auto body = instants.body(
        lines, options.start + std::chrono::microseconds(*stamp - *first), BodyId{*person});
    if (!body) return pass(body);
    (*body)->skeleton = *skeleton;
  }
}

}  // namespace

Result<record::FrameRecording> read_joint_csv(const std::filesystem::path& file,
                                              const ImportOptions& options) {
  return read_text_recording(file, options, {"joints (csv)", {}, "row", read_joint_rows});
}

Result<record::FrameRecording> read_frame_lines(const std::filesystem::path& file,
                                                const ImportOptions& options) {
  return read_text_recording(file, options, {"frames (ndjson)", {}, "line", read_ndjson_lines});
}

Result<record::FrameRecording> read_azure_kinect_csv(const std::filesystem::path& file,
                                                     const ImportOptions& options) {
  return read_text_recording(file, options,
                             {"Azure Kinect (PyMoCapViewer csv)",
                              {{"time", "the file counts microseconds of the device; moved to " +
                                            to_iso8601(options.start)}},
                              "row",
                              read_azure_rows});
}

}  // namespace chorus::importers
