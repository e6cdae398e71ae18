#include "tests/bench/inertial/real_takes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "common/base/file.h"
#include "common/base/parse.h"
#include "common/evaluation/pronation.h"
#include "common/inertial/inertial_frame.h"
#include "tests/bench/inertial/inertial_cases.h"

namespace chorus::bench {
namespace {

namespace fs = std::filesystem;
using evaluation::OrientationTrack;
using inertial::Limb;

constexpr std::uintmax_t kMostTakeBytes = 64u << 20;
constexpr double kTakeGravity = 9.81;

using NumberRows = std::vector<std::vector<double>>;

/// Lines of numbers; any of `separators` parts them.  Lines that are no numbers are left out.
Result<NumberRows> number_rows_of(const fs::path& file, std::string_view separators) {
  const auto text = read_file(file, kMostTakeBytes);
  if (!text) return pass(text);
  NumberRows out;
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);) {
    for (char& c : line)
      if (separators.find(c) != std::string_view::npos || c == '\r') c = ' ';
    std::vector<double> numbers;
    std::istringstream words(line);
    bool fine = true;
    for (std::string word; words >> word;) {
      const auto value = parse_finite(word);
      fine = fine && (value || word == "NaN" || word == "nan");
      numbers.push_back(value.value_or(std::nan("")));
    }
    if (fine && !numbers.empty()) out.push_back(std::move(numbers));
  }
  return out;
}

Eigen::Quaterniond wxyz(const std::vector<double>& row, std::size_t at) {
  return {row[at], row[at + 1], row[at + 2], row[at + 3]};
}
Eigen::Quaterniond xyzw(const std::vector<double>& row, std::size_t at) {
  return {row[at + 3], row[at], row[at + 1], row[at + 2]};
}
Eigen::Vector3d triple(const std::vector<double>& row, std::size_t at) {
  return {row[at], row[at + 1], row[at + 2]};
}

double free_acceleration(const Eigen::Quaterniond& up_from_sensor, const Eigen::Vector3d& force) {
  return (up_from_sensor * force - Eigen::Vector3d(0, kTakeGravity, 0)).norm();
}

struct SevenRow {
  const char* file;
  Limb limb;
  std::size_t quaternion;  ///< Column of the optical one.
  std::size_t place;       ///< Column of the joint that moves with the sensor.
};
// clang-format off
constexpr std::array<SevenRow, 7> kSeven{{
  {"Pelvis", Limb::Pelvis, 27, 0}, {"R_UpLeg", Limb::ThighRight, 31, 18}, {"L_UpLeg", Limb::ThighLeft, 35, 6},
  {"R_LowLeg", Limb::ShankRight, 39, 21}, {"L_LowLeg", Limb::ShankLeft, 43, 9},
  {"R_Foot", Limb::FootRight, 47, 24}, {"L_Foot", Limb::FootLeft, 51, 12}}};
// clang-format on

Result<RealTake> seven() {
  constexpr double kRate = 100.0;
  const fs::path folder = shared_recordings() / "gait_imu_vicon" / "data" / "sample";
  const auto optical = number_rows_of(folder / "vicon" / "S02-Trial-Walk-1.csv", ",");
  if (!optical) return pass(optical);
  const Eigen::Quaterniond up = inertial::y_up_from_z_up();
  RealTake take{"xsens7", {}};
  for (const SevenRow& row : kSeven) {
    const auto sensed = number_rows_of(
        folder / "imu" / (std::string("S02-Trial-Walk-1-") + row.file + ".csv"), ",");
    if (!sensed) return pass(sensed);
    RealSensor sensor;
    sensor.limb = row.limb;
    for (std::size_t i = 0; i < std::min(optical->size(), sensed->size()); ++i) {
      const double t = static_cast<double>(i) / kRate;
      const auto& seen = (*optical)[i];
      sensor.optical.push_back({t, (up * wxyz(seen, row.quaternion)).normalized()});
      sensor.places.push_back({t, up * triple(seen, row.place)});
      const Eigen::Quaterniond q = (up * wxyz((*sensed)[i], 0)).normalized();
      sensor.inertial.push_back({t, q});
      sensor.acceleration.push_back({t, free_acceleration(q, triple((*sensed)[i], 4))});
    }
    take.sensors.push_back(std::move(sensor));
  }
  return take;
}

struct ThirteenRow {
  std::size_t segment;  ///< Of the 21 of the files.
  Limb limb;
};
// clang-format off
constexpr std::array<ThirteenRow, 13> kThirteen{{
  {0, Limb::Pelvis}, {4, Limb::Chest}, {6, Limb::Head}, {8, Limb::UpperArmRight}, {9, Limb::ForearmRight},
  {12, Limb::UpperArmLeft}, {13, Limb::ForearmLeft}, {15, Limb::ThighRight}, {16, Limb::ShankRight},
  {17, Limb::FootRight}, {18, Limb::ThighLeft}, {19, Limb::ShankLeft}, {20, Limb::FootLeft}}};
// clang-format on

std::vector<Eigen::Quaterniond> segments_in(const std::vector<double>& row) {
  std::vector<Eigen::Quaterniond> out;
  for (std::size_t at = 0; at + 4 <= row.size(); at += 4) out.push_back(xyzw(row, at).normalized());
  return out;
}

Result<RealTake> thirteen(const fs::path& folder) {
  constexpr double kRate = 60.0;
  constexpr double kInch = 0.0254;
  constexpr std::size_t kFirstHalf = 1500;
  const auto sensed = number_rows_of(folder / "output_quat_accel.csv", ",");
  const auto turned = number_rows_of(folder / "gt_skel_gbl_ori.txt", "\t");
  const auto placed = number_rows_of(folder / "gt_skel_gbl_pos.txt", "\t");
  if (!sensed) return pass(sensed);
  if (!turned) return pass(turned);
  if (!placed) return pass(placed);
  const Eigen::Quaterniond up = inertial::y_up_from_z_up();
  RealTake take{"xsens13", {}};
  for (const ThirteenRow& row : kThirteen) {
    RealSensor sensor;
    sensor.limb = row.limb;
    for (std::size_t i = 0;
         i < std::min({kFirstHalf, sensed->size(), turned->size(), placed->size()}); ++i) {
      const double t = static_cast<double>(i) / kRate;
      const auto& raw = (*sensed)[i];
      if (raw.size() < 7 * row.segment + 7 || (*turned)[i].size() < 4 * row.segment + 4) continue;
      const Eigen::Quaterniond q = (up * xyzw(raw, 7 * row.segment)).normalized();
      sensor.optical.push_back({t, under_sensor(row.limb, segments_in((*turned)[i]))});
      sensor.places.push_back({t, kInch * triple((*placed)[i], 3 * row.segment)});
      sensor.inertial.push_back({t, q});
      sensor.acceleration.push_back({t, free_acceleration(q, triple(raw, 7 * row.segment + 4))});
    }
    take.sensors.push_back(std::move(sensor));
  }
  return take;
}

}  // namespace

Result<std::vector<RealTake>> real_takes() {
  std::vector<RealTake> out;
  std::error_code absent;
  if (fs::exists(shared_recordings() / "gait_imu_vicon", absent)) {
    auto take = seven();
    if (!take) return pass(take);
    out.push_back(std::move(*take));
  }
  if (const char* const folder = std::getenv("CHORUS_XSENS13")) {
    auto take = thirteen(folder);
    if (!take) return pass(take);
    out.push_back(std::move(*take));
  }
  return out;
}

Result<std::vector<std::vector<Eigen::Quaterniond>>> orientation_rows(const fs::path& file) {
  const auto rows = number_rows_of(file, "\t");
  if (!rows) return pass(rows);
  std::vector<std::vector<Eigen::Quaterniond>> out;
  for (const auto& row : *rows) out.push_back(segments_in(row));
  const bool whole = std::ranges::all_of(out, [](const auto& row) { return row.size() > 20; });
  if (out.empty() || !whole)
    return fail(ErrorCode::Malformed, file.string(), "must have 21 quaternions a line.");
  return out;
}

std::size_t segment_of(Limb limb) {
  const auto row = std::ranges::find(kThirteen, limb, &ThirteenRow::limb);
  return row == kThirteen.end() ? 0 : row->segment;
}

Eigen::Quaterniond under_sensor(Limb limb, const std::vector<Eigen::Quaterniond>& segments) {
  const std::size_t segment = segment_of(limb);
  if (limb != Limb::ForearmLeft && limb != Limb::ForearmRight) return segments[segment];
  return evaluation::forearm_at_sensor(segments[segment], segments[segment + 1],
                                       Eigen::Vector3d::UnitX());
}

evaluation::OrientationPairs pairs_of(const RealSensor& sensor, double shift) {
  evaluation::OrientationPairs out;
  for (const auto& each : sensor.optical) {
    const auto sensed = evaluation::orientation_at(sensor.inertial, each.time - shift);
    if (sensed && each.value.coeffs().allFinite())
      out.push_back({each.time, {each.value, Eigen::Matrix3d::Zero(), true}, *sensed});
  }
  return out;
}

}  // namespace chorus::bench
