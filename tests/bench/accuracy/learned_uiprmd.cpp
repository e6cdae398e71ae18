// UI-PRMD: one Kinect v2 and Vicon at once, of people who face the sensor.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "common/base/units.h"
#include "common/body/facing.h"
#include "common/geometry/rigid_fit.h"
#include "common/importers/text_rows.h"
#include "tests/bench/accuracy/learned_views.h"

// A namespace of its own: other benchmarks have pairs, fits and rates, too.
namespace chorus::bench::uiprmd {
namespace {

namespace fs = std::filesystem;
using enum JointId;

constexpr double kUiprmdRate = 30.0;   // [Hz]
constexpr double kViconRate = 100.0;   // [Hz]
constexpr double kSensorHeight = 1.0;  // [m]; not published, so the elevation counts as unknown
constexpr std::size_t kKinectJoints = 22;
constexpr std::size_t kMarkers = 39;
constexpr std::array<int, kKinectJoints> kParents{-1, 0,  1,  2, 3,  4,  2,  6, 7,  8,  2,
                                                  10, 11, 12, 0, 14, 15, 16, 0, 18, 19, 20};

/// A joint of ours: its number in the Kinect's files, and the markers whose mean is its centre.
struct Pair {
  JointId joint;
  std::size_t kinect;
  std::array<int, 4> markers;  ///< -1: none.
};
constexpr std::array<Pair, 11> kPairs{{{SpineBase, 0, {23, 24, 25, 26}},
                                       {ShoulderLeft, 7, {9, -1, -1, -1}},
                                       {ElbowLeft, 8, {11, -1, -1, -1}},
                                       {WristLeft, 9, {13, 14, -1, -1}},
                                       {ShoulderRight, 11, {16, -1, -1, -1}},
                                       {ElbowRight, 12, {18, -1, -1, -1}},
                                       {WristRight, 13, {20, 21, -1, -1}},
                                       {KneeLeft, 15, {28, -1, -1, -1}},
                                       {AnkleLeft, 16, {30, -1, -1, -1}},
                                       {KneeRight, 19, {34, -1, -1, -1}},
                                       {AnkleRight, 20, {36, -1, -1, -1}}}};
using Places = std::array<Eigen::Vector3d, kPairs.size()>;

Result<std::string> unpacked(const fs::path& file) {
  gzFile const packed = gzopen(file.c_str(), "rb");
  if (packed == nullptr) return fail(ErrorCode::NotFound, file.string(), "cannot be read");
  std::string text;
  std::array<char, 1U << 16U> part{};
  int count = 0;
  while ((count = gzread(packed, part.data(), part.size())) > 0)
    text.append(part.data(), static_cast<std::size_t>(count));
  gzclose(packed);
  if (count == 0) return text;
  return fail(ErrorCode::Malformed, file.string(), "is no whole gzip file");
}

/// Rows of comma-separated points.
Result<std::vector<std::vector<Eigen::Vector3d>>> read_points(const fs::path& file,
                                                              std::size_t points) {
  const auto text = unpacked(file);
  if (!text) return pass(text);
  importers::LineReader lines(*text, file.string());
  std::vector<std::vector<Eigen::Vector3d>> rows;
  while (const auto line = lines.next_filled()) {
    const auto row = importers::Row::split(lines, *line, ',', 3 * points);
    if (!row) return pass(row);
    std::vector<double> numbers(3 * points);
    if (auto ok = row->numbers(0, numbers, 1e5); !ok) return pass(ok);
    auto& found = rows.emplace_back();
    for (std::size_t i = 0; i < points; ++i)
      found.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  }
  return rows;
}

/// Forward kinematics: places [cm] and Euler angles [deg] in the parent's frame, R = Rz Rx Ry.  The
/// files' -z is the depth, so the result is turned about +y to sensor space.
Skeleton<SensorSpace> body_of(const std::vector<Eigen::Vector3d>& places,
                              const std::vector<Eigen::Vector3d>& angles) {
  std::array<Eigen::Isometry3d, kKinectJoints> joints;
  for (std::size_t i = 0; i < kKinectJoints; ++i) {
    const Eigen::Vector3d turn = angles[i] * deg(1);
    Eigen::Isometry3d own = Eigen::Isometry3d::Identity();
    own.translation() = 0.01 * places[i];
    own.linear() = (Eigen::AngleAxisd(turn.z(), Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(turn.x(), Eigen::Vector3d::UnitX()) *
                    Eigen::AngleAxisd(turn.y(), Eigen::Vector3d::UnitY()))
                       .toRotationMatrix();
    joints[i] = kParents[i] < 0 ? own : joints[static_cast<std::size_t>(kParents[i])] * own;
  }
  Skeleton<SensorSpace> body;
  const auto place = [&](JointId id, std::size_t from) {
    const Eigen::Vector3d& at = joints[from].translation();
    body[id].position = {-at.x(), at.y() - kSensorHeight, -at.z()};
    body[id].state = JointState::Tracked;
  };
  for (const Pair& pair : kPairs) place(pair.joint, pair.kinect);
  place(Neck, 3);
  return body;
}

struct Episode {
  std::vector<Skeleton<SensorSpace>> seen;  ///< At 30 Hz.
  std::vector<Places> vicon;                ///< At 100 Hz [m].
};

Places centres_of(const std::vector<Eigen::Vector3d>& markers) {
  Places places;
  for (std::size_t i = 0; i < kPairs.size(); ++i) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0.0;
    for (const int marker : kPairs[i].markers) {
      if (marker < 0) continue;
      sum += markers[static_cast<std::size_t>(marker)];
      count += 1.0;
    }
    places[i] = mm(1) * sum / count;
  }
  return places;
}

fs::path vicon_file(const fs::path& folder, const std::string& name) {
  return folder / "vicon_positions" / (name + "_positions.txt.gz");
}

Result<Episode> read_episode(const fs::path& folder, const std::string& name) {
  const auto places =
      read_points(folder / "kinect_positions" / (name + "_positions.txt.gz"), kKinectJoints);
  if (!places) return pass(places);
  const auto angles =
      read_points(folder / "kinect_angles" / (name + "_angles.txt.gz"), kKinectJoints);
  if (!angles) return pass(angles);
  const auto markers = read_points(vicon_file(folder, name), kMarkers);
  if (!markers) return pass(markers);
  Episode episode;
  for (std::size_t i = 0; i < std::min(places->size(), angles->size()); ++i)
    episode.seen.push_back(body_of((*places)[i], (*angles)[i]));
  for (const auto& row : *markers) episode.vicon.push_back(centres_of(row));
  return episode;
}

/// Where Vicon saw the joints at a frame of the Kinect; none beyond the ends of the recording.
std::optional<Places> vicon_at(const Episode& episode, std::size_t frame, double shift) {
  const double at = (static_cast<double>(frame) / kUiprmdRate + shift) * kViconRate;
  if (at < 0.0 || at + 1.0 >= static_cast<double>(episode.vicon.size())) return std::nullopt;
  const auto before = static_cast<std::size_t>(at);
  const double part = at - static_cast<double>(before);
  Places places;
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = (1.0 - part) * episode.vicon[before][i] + part * episode.vicon[before + 1][i];
  return places;
}

struct Fitted {
  Eigen::Isometry3d sensor_from_vicon = Eigen::Isometry3d::Identity();
  double shift = 0.0;  ///< [s]
  double rms = std::numeric_limits<double>::infinity();
};

Fitted fit_at(const Episode& episode, double shift) {
  constexpr std::size_t kStep = 3;
  std::vector<Eigen::Vector3d> source;
  std::vector<Eigen::Vector3d> target;
  for (std::size_t f = 0; f < episode.seen.size(); f += kStep) {
    const auto vicon = vicon_at(episode, f, shift);
    if (!vicon) continue;
    for (std::size_t i = 0; i < kPairs.size(); ++i) {
      source.push_back((*vicon)[i]);
      target.push_back(episode.seen[f][kPairs[i].joint].position);
    }
  }
  const auto found = fit_rigid(source, target);
  return found ? Fitted{found->target_from_source, shift, found->rms} : Fitted{};
}

Fitted fit_episode(const Episode& episode) {
  constexpr double kFarthest = 0.6;  // [s]
  constexpr double kStep = 0.02;
  Fitted best;
  for (double shift = -kFarthest; shift <= kFarthest; shift += kStep) {
    const Fitted found = fit_at(episode, shift);
    if (found.rms < best.rms) best = found;
  }
  return best;
}

/// Body axes from the shoulders: x across, y up; in sensor space.
Eigen::Matrix3d axes_of(const Skeleton<SensorSpace>& body) {
  const Eigen::Vector3d across = body[ShoulderLeft].position - body[ShoulderRight].position;
  const Eigen::Vector3d level = Eigen::Vector3d(across.x(), 0.0, across.z()).normalized();
  Eigen::Matrix3d axes;
  axes << level, Eigen::Vector3d::UnitY(), level.cross(Eigen::Vector3d::UnitY());
  return axes;
}

struct Seen {
  Skeleton<SensorSpace> body;
  Places exact;  ///< In sensor space.
};

void take_offsets(std::vector<Seen>& all) {
  Places mean;
  mean.fill(Eigen::Vector3d::Zero());
  for (const Seen& seen : all) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const Eigen::Vector3d off = seen.body[kPairs[i].joint].position - seen.exact[i];
      mean[i] += axes_of(seen.body).transpose() * off / static_cast<double>(all.size());
    }
  }
  for (Seen& seen : all) {
    for (std::size_t i = 0; i < mean.size(); ++i) seen.exact[i] += axes_of(seen.body) * mean[i];
  }
}

Samples samples_of(const std::vector<Seen>& all) {
  constexpr auto kUnknown = std::numeric_limits<double>::quiet_NaN();
  Samples samples;
  for (const Seen& seen : all) {
    Person person;
    SensorView& view = person.views.emplace_back();
    view.sensor = SensorId::parse("kinect").value();
    view.skeleton = to_world(Eigen::Isometry3d::Identity(), seen.body);
    view.facing = facing_angle(seen.body).value_or(kUnknown);
    view.bearing = bearing_angle(seen.body).value_or(kUnknown);
    Skeleton<WorldSpace> exact;
    for (std::size_t i = 0; i < kPairs.size(); ++i) {
      exact[kPairs[i].joint].position = seen.exact[i];
      exact[kPairs[i].joint].state = JointState::Tracked;
    }
    learn::add_samples(person, exact, samples);
  }
  for (learn::ErrorSample& sample : samples) {
    for (const auto lacking :
         {fusion::Feature::Inferred, fusion::Feature::Elevation, fusion::Feature::Untracked})
      sample.features[static_cast<std::size_t>(lacking)] = kUnknown;
  }
  return samples;
}

Result<std::map<std::string, std::vector<Seen>>> read_people(const fs::path& folder,
                                                             std::size_t step) {
  constexpr std::size_t kMovement = 3;  // letters of "m01"
  std::map<std::string, std::vector<Seen>> people;
  for (const auto& file : fs::directory_iterator(folder / "kinect_positions")) {
    const std::string name = file.path().filename().string().substr(0, 11);  // "m01_s01_e01"
    // Two of the hundred have no Vicon part.
    if (!fs::exists(vicon_file(folder, name))) continue;
    const auto episode = read_episode(folder, name);
    if (!episode) return pass(episode);
    const Fitted fitted = fit_episode(*episode);
    auto& seen = people[name.substr(kMovement + 1, 3)];
    for (std::size_t f = 0; f < episode->seen.size(); f += step) {
      auto vicon = vicon_at(*episode, f, fitted.shift);
      if (!vicon) continue;
      for (Eigen::Vector3d& place : *vicon) place = fitted.sensor_from_vicon * place;
      seen.push_back({episode->seen[f], *vicon});
    }
  }
  return people;
}

}  // namespace
}  // namespace chorus::bench::uiprmd

namespace chorus::bench {

Result<std::map<std::string, Samples>> uiprmd_samples(const std::filesystem::path& folder,
                                                      bool own_places, std::size_t step) {
  auto people = uiprmd::read_people(folder, step);
  if (!people) return pass(people);
  std::map<std::string, Samples> samples;
  for (auto& [person, seen] : *people) {
    if (own_places) uiprmd::take_offsets(seen);
    samples[person] = uiprmd::samples_of(seen);
  }
  return samples;
}

}  // namespace chorus::bench
