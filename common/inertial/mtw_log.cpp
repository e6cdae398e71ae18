#include "common/inertial/mtw_log.h"

#include <array>
#include <cmath>

#include "common/base/parse.h"
#include "common/geometry/rotation.h"
#include "common/inertial/text_columns.h"

namespace chorus::inertial {
namespace {

using Column = std::optional<std::size_t>;
constexpr double kUsualRate = 100.0;  // where the log does not state it
constexpr unsigned kCounterBits = 16;
constexpr double kUnitTolerance = 0.02;

struct MtwColumns {
  Column counter;
  std::array<Column, 4> quaternion;
  std::array<Column, 9> matrix;
  std::array<Column, 3> acceleration, rate, field;
};

std::array<Column, 3> three_of(const TextColumns& text, const std::string& name) {
  return {text.column(name + "_X"), text.column(name + "_Y"), text.column(name + "_Z")};
}

MtwColumns columns_of(const TextColumns& text) {
  MtwColumns out{text.column("PacketCounter"), {}, {}, three_of(text, "Acc"), three_of(text, "Gyr"),
                 three_of(text, "Mag")};
  for (std::size_t i = 0; i < 4; ++i) out.quaternion[i] = text.column("Quat_q" + std::to_string(i));
  for (std::size_t i = 0; i < 9; ++i)
    out.matrix[i] =
        text.column("Mat[" + std::to_string(i % 3 + 1) + "][" + std::to_string(i / 3 + 1) + "]");
  return out;
}

template <std::size_t N>
std::optional<Eigen::Matrix<double, int(N), 1>> numbers(const TextColumns& text,
                                                        const std::array<Column, N>& columns) {
  Eigen::Matrix<double, int(N), 1> out;
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = text.number(columns[i]);
    if (!value) return std::nullopt;
    out(static_cast<Eigen::Index>(i)) = *value;
  }
  return out;
}

/// Nothing where the line has none; not unit where it is damaged.
std::optional<Eigen::Quaterniond> orientation_of(const TextColumns& text,
                                                 const MtwColumns& columns) {
  if (const auto q = numbers(text, columns.quaternion))
    return Eigen::Quaterniond((*q)(0), (*q)(1), (*q)(2), (*q)(3));
  const auto m = numbers(text, columns.matrix);
  if (!m) return std::nullopt;
  const Eigen::Matrix3d r = Eigen::Map<const Eigen::Matrix3d>(m->data());
  const bool rotates = (r.transpose() * r).isApprox(Eigen::Matrix3d::Identity(), kUnitTolerance);
  if (!rotates || r.determinant() < 0) return Eigen::Quaterniond(0, 0, 0, 0);
  return Eigen::Quaterniond(r);
}

double rate_in(const std::vector<std::string>& preamble) {
  constexpr std::string_view kName = "Update Rate:";
  for (const std::string& line : preamble) {
    const std::size_t at = line.find(kName);
    if (at == std::string::npos) continue;
    std::string_view rest = std::string_view(line).substr(at + kName.size());
    while (rest.starts_with(' ')) rest.remove_prefix(1);
    const auto rate = take_number<double>(rest);
    if (rate && *rate > 0 && *rate <= 2000) return *rate;
  }
  return kUsualRate;
}

Result<InertialReading> reading_of(const TextColumns& text, const MtwColumns& columns) {
  InertialReading out;
  const auto orientation = orientation_of(text, columns);
  if (orientation && std::abs(orientation->norm() - 1.0) > kUnitTolerance)
    return fail(ErrorCode::Malformed, text.where(), "its orientation is no rotation");
  if (orientation)
    out.inertial_from_sensor = normalised_or_identity(y_up_from_z_up() * *orientation);
  out.acceleration = numbers(text, columns.acceleration);
  out.rate = numbers(text, columns.rate);
  out.field = numbers(text, columns.field);
  return out;
}

void tell(SensorLog& log, std::uint64_t lost, std::size_t repeated) {
  if (lost > 0) log.notes.push_back(std::to_string(lost) + " samples are missing by the counter");
  if (repeated > 0)
    log.notes.push_back(std::to_string(repeated) + " samples repeat the counter and were left out");
}

}  // namespace

std::optional<std::uint64_t> WrappedCounter::next(std::uint64_t value) {
  if (last_) {
    const std::uint64_t step = (value + range_ - *last_ % range_) % range_;
    if (step > range_ / 2) return std::nullopt;
    total_ += step;
  }
  last_ = value % range_;
  return total_;
}

Result<SensorLog> parse_mtw_log(std::string_view text, std::string_view origin,
                                const std::string& sensor) {
  if (text.size() > kMaxLogBytes)
    return fail(ErrorCode::TooLarge, std::string(origin), "is too large");
  auto lines = TextColumns::of(text, origin, {"PacketCounter"});
  if (!lines) return pass(lines);
  const MtwColumns columns = columns_of(*lines);
  if (!columns.quaternion[3] && !columns.matrix[8])
    return fail(ErrorCode::Malformed, std::string(origin),
                "has no orientation; export quaternions (Quat_q0...) or matrices (Mat[1][1]...)");
  SensorLog log{sensor, rate_in(lines->preamble()), {}};
  WrappedCounter counter(kCounterBits);
  std::uint64_t lost = 0;
  std::size_t repeated = 0;
  std::optional<std::uint64_t> before;
  while (lines->next()) {
    const auto count = parse_number<std::uint64_t>(lines->cell(*columns.counter));
    const auto place = count ? counter.next(*count) : std::nullopt;
    if (!place)
      return fail(ErrorCode::Malformed, lines->where(),
                  "its PacketCounter is no number or runs backward");
    repeated += before == place ? 1 : 0;
    if (before == place) continue;
    lost += before ? *place - *before - 1 : 0;
    before = place;
    auto reading = reading_of(*lines, columns);
    if (!reading) return pass(reading);
    reading->sensor = sensor;
    reading->captured = from_unix_ns(std::llround(1e9 * static_cast<double>(*place) / log.rate_hz));
    if (reading->inertial_from_sensor) log.readings.push_back(std::move(*reading));
  }
  tell(log, lost, repeated);
  if (!log.readings.empty()) return log;
  return fail(ErrorCode::Malformed, std::string(origin), "holds no sample with an orientation");
}

std::string mtw_sensor_of(std::string_view file_stem) {
  const std::size_t at = file_stem.rfind('_');
  const bool ends = at != std::string_view::npos && file_stem.size() - at == 9;
  return std::string(ends ? file_stem.substr(at + 1) : file_stem);
}

}  // namespace chorus::inertial
