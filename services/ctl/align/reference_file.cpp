#include "services/ctl/align/reference_file.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/base/duration.h"
#include "common/base/parse.h"
#include "common/base/units.h"
#include "common/geometry/rotation.h"
#include "common/importers/table.h"
#include "common/time/timestamp.h"

namespace chorus::ctl {
namespace {

using importers::LineReader;
using importers::Table;

constexpr double kMostUnits = 1e7;
constexpr std::string_view kMotive = "Format Version";

/// x_in_ours = matrix * x_in_reference.
Eigen::Matrix3d ours_from(ReferenceAxes axes) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Identity();
  if (axes == ReferenceAxes::ZUp) matrix << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  if (axes == ReferenceAxes::Unity) matrix(2, 2) = -1.0;
  return matrix;
}

class Converter {
 public:
  Converter(ReferenceAxes axes, double metres_per_unit)
      : matrix_(ours_from(axes)), scale_(metres_per_unit) {}

  [[nodiscard]] Eigen::Vector3d place(const Eigen::Vector3d& p) const {
    return scale_ * (matrix_ * p);
  }
  [[nodiscard]] std::optional<Eigen::Quaterniond> turn(const Eigen::Quaterniond& q) const {
    if (!is_unit(q)) return std::nullopt;
    const Eigen::Matrix3d rotation = q.normalized().toRotationMatrix();
    return Eigen::Quaterniond(Eigen::Matrix3d(matrix_ * rotation * matrix_.transpose()));
  }

 private:
  Eigen::Matrix3d matrix_;
  double scale_;
};

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    fields.push_back(importers::trimmed(line.substr(at, end - at), " \t\r\""));
    at = end + 1;
  }
  return fields;
}

std::string_view field_at(const std::vector<std::string_view>& fields, std::size_t i) {
  return i < fields.size() ? fields[i] : std::string_view();
}

/// The value after this key in the first line of a Motive file.
std::string_view motive_value(const std::vector<std::string_view>& head, std::string_view key) {
  for (std::size_t i = 0; i + 1 < head.size(); ++i) {
    if (head[i] == key) return head[i + 1];
  }
  return {};
}

double motive_unit(std::string_view word) {
  if (word.starts_with("Milli")) return mm(1.0);
  if (word.starts_with("Centi")) return mm(10.0);
  return 1.0;
}

/// Columns of one body; 0: there is none, because the first two columns are frame and time.
struct MotiveBody {
  std::array<std::size_t, 3> place{};
  std::array<std::size_t, 4> turn{};
};

struct MotiveHead {
  std::map<std::string, MotiveBody> bodies;
  std::size_t width = 0;
};

/// The rows between the first line and the numbers: type, name, id, (parent,) what, axis.
Result<MotiveHead> motive_head(LineReader& lines) {
  std::vector<std::string_view> names;
  std::vector<std::string_view> kinds;
  std::vector<std::string_view> row;
  for (auto line = lines.next_filled(); line; line = lines.next_filled()) {
    row = fields_of(*line);
    if (field_at(row, 1) == "Name") names = row;
    if (field_at(row, 0) == "Frame") break;
    kinds = row;
  }
  MotiveHead head;
  head.width = row.size();
  if (names.empty() || field_at(row, 0) != "Frame")
    return lines.malformed("has no rows Name and Frame, as Motive writes them");
  constexpr std::string_view kAxes = "XYZW";
  for (std::size_t i = 2; i < row.size(); ++i) {
    const std::size_t axis = row[i].size() == 1 ? kAxes.find(row[i]) : std::string_view::npos;
    if (axis == std::string_view::npos) continue;
    MotiveBody& body = head.bodies[std::string(field_at(names, i))];
    if (field_at(kinds, i) == "Position" && axis < 3) body.place[axis] = i;
    if (field_at(kinds, i) == "Rotation") body.turn[axis] = i;
  }
  std::erase_if(head.bodies, [](const auto& entry) { return entry.second.place[2] == 0; });
  if (head.bodies.empty()) return lines.malformed("has no columns of positions");
  return head;
}

std::optional<ReferenceSample> motive_sample(const std::vector<std::string_view>& row,
                                             const MotiveBody& body, const Converter& convert) {
  Eigen::Vector3d place;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto value = parse_finite(field_at(row, body.place[axis]));
    if (!value) return std::nullopt;
    place[static_cast<Eigen::Index>(axis)] = *value;
  }
  ReferenceSample sample{0.0, convert.place(place), {}};
  std::array<double, 4> q{};
  for (std::size_t axis = 0; axis < 4; ++axis) {
    if (body.turn[axis] == 0) return sample;  // none, or as Euler angles
    const auto value = parse_finite(field_at(row, body.turn[axis]));
    if (!value) return sample;
    q[axis] = *value;
  }
  sample.turn = convert.turn({q[3], q[0], q[1], q[2]});
  return sample;
}

Result<Reference> read_motive(std::string_view text, const std::string& name,
                              const ReferenceOptions& options) {
  LineReader lines(text, name);
  const auto first = fields_of(lines.next().value_or(""));
  const double unit =
      options.metres_per_unit.value_or(motive_unit(motive_value(first, "Length Units")));
  const Converter convert(options.axes, unit);
  auto head = motive_head(lines);
  if (!head) return pass(head);
  Reference out;
  double last = -1.0;
  for (auto line = lines.next_filled(); line; line = lines.next_filled()) {
    const auto row = fields_of(*line);
    const auto time = parse_finite(field_at(row, 1));
    if (!time || !(*time > last)) return lines.malformed("has no time that increases");
    last = *time;
    for (const auto& [body, columns] : head->bodies) {
      auto sample = motive_sample(row, columns, convert);
      if (!sample) continue;
      sample->time = *time;
      out.bodies[body].push_back(std::move(*sample));
    }
  }
  return out;
}

/// The names that other programs give to a column; the first that the table has.
std::string column_of(const Table& table, std::initializer_list<const char*> names) {
  for (const char* each : names) {
    if (table.has(each)) return each;
  }
  return {};
}

struct Columns {
  std::string time, x, y, z, name, person;
  bool turns = false;

  [[nodiscard]] static Columns of(const Table& table) {
    return {column_of(table, {"utc", "time", "time_s", "t", "timestamp"}),
            column_of(table, {"x", "x_m", "x_mm"}),
            column_of(table, {"y", "y_m", "y_mm"}),
            column_of(table, {"z", "z_m", "z_mm"}),
            column_of(table, {"name", "body", "joint", "sensor"}),
            column_of(table, {"person"}),
            table.has("qx") && table.has("qy") && table.has("qz") && table.has("qw")};
  }
  [[nodiscard]] bool complete() const { return !x.empty() && !y.empty() && !z.empty(); }
};

struct Moment {
  double time = 0.0;
  bool utc = false;
};

/// Seconds, or a date with a zone.  A table without a time is a list of things at rest.
Result<Moment> moment_of(const Table& table, const Columns& columns, double fallback) {
  if (columns.time.empty()) return Moment{fallback, false};
  const std::string_view field = table.field(columns.time);
  if (const auto number = parse_finite(field)) return Moment{*number, *number > 1e9};
  const auto date = parse_iso8601(field);
  if (!date) return table.wrong(columns.time, "neither seconds nor a date with a zone");
  return Moment{seconds(date->time_since_epoch()), true};
}

Result<std::optional<ReferenceSample>> table_sample(const Table& table, const Columns& columns,
                                                    const Converter& convert) {
  Eigen::Vector3d place;
  const std::array names{&columns.x, &columns.y, &columns.z};
  for (std::size_t axis = 0; axis < names.size(); ++axis) {
    const auto value = table.number(*names[axis], kMostUnits);
    if (!value) return pass(value);
    if (!*value) return std::optional<ReferenceSample>();
    place[static_cast<Eigen::Index>(axis)] = **value;
  }
  ReferenceSample sample{0.0, convert.place(place), {}};
  if (!columns.turns) return std::optional(sample);
  std::array<double, 4> q{};
  constexpr std::array kTurn{"qx", "qy", "qz", "qw"};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto value = table.number(kTurn[i], 2.0);
    if (!value) return pass(value);
    q[i] = value->value_or(0.0);
  }
  sample.turn = convert.turn({q[3], q[0], q[1], q[2]});
  return std::optional(sample);
}

std::string body_of(const Table& table, const Columns& columns) {
  std::string name(columns.name.empty() ? std::string_view() : table.field(columns.name));
  if (columns.person.empty()) return name;
  return fmt::format("{}/{}", table.field(columns.person), name);
}

/// Joints of one person only need no number of a person.
void shorten_names(Reference& reference) {
  std::string person;
  for (const auto& [name, samples] : reference.bodies) {
    const std::string own = name.substr(0, name.find('/'));
    if (!person.empty() && own != person) return;
    person = own;
  }
  std::map<std::string, std::vector<ReferenceSample>> shorter;
  for (auto& [name, samples] : reference.bodies)
    shorter[name.substr(name.find('/') + 1)] = std::move(samples);
  reference.bodies = std::move(shorter);
}

Result<Reference> read_table(std::string_view text, const std::string& name,
                             const ReferenceOptions& options) {
  LineReader lines(text, name);
  auto table = Table::open(lines);
  if (!table) return pass(table);
  const Columns columns = Columns::of(*table);
  if (!columns.complete())
    return lines.malformed(
        "is neither Motive's CSV nor a table with columns such as time,x,y,z (and name, qx, qy, "
        "qz, qw)");
  const double unit = options.metres_per_unit.value_or(columns.x == "x_mm" ? mm(1.0) : 1.0);
  const Converter convert(options.axes, unit);
  Reference out;
  for (auto more = table->next(); !more || *more; more = table->next()) {
    if (!more) return pass(more);
    auto sample = table_sample(*table, columns, convert);
    if (!sample) return pass(sample);
    if (!*sample) continue;
    auto& samples = out.bodies[body_of(*table, columns)];
    const auto moment = moment_of(*table, columns, static_cast<double>(samples.size()));
    if (!moment) return pass(moment);
    if (!samples.empty() && !(moment->time > samples.back().time))
      return lines.malformed("has a time that does not increase");
    out.utc = moment->utc;
    (*sample)->time = moment->time;
    samples.push_back(std::move(**sample));
  }
  if (!columns.person.empty()) shorten_names(out);
  return out;
}

}  // namespace

Result<Reference> read_reference(std::string_view text, const std::string& name,
                                 const ReferenceOptions& options) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  auto out = text.starts_with(kMotive) ? read_motive(text, name, options)
                                       : read_table(text, name, options);
  if (out && out->bodies.empty()) return fail(ErrorCode::Malformed, name, "holds no place");
  return out;
}

}  // namespace chorus::ctl
