#include "common/importers/captured.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "common/base/median.h"
#include "common/base/parse.h"
#include "common/importers/text_rows.h"
#include "common/motion/bvh.h"
#include "common/motion/c3d.h"
#include "common/motion/htr.h"
#include "common/motion/mvnx.h"
#include "common/motion/stature.h"
#include "common/motion/trc.h"

namespace chorus::importers {
namespace {

constexpr std::size_t kShownLabels = 40;
constexpr double kCentimetre = 0.01;
constexpr const char* kHowToName =
    "; say which makes which with --joints FILE (a template is written beside the output)";

std::string list_of(const std::vector<std::string>& labels) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShownLabels, labels.size()); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : " ", labels[i].substr(0, 32));
  return labels.size() > kShownLabels ? text + " ..." : text;
}

/// "P10" -> 10: files that Chorus exports name persons like this.
std::optional<std::uint64_t> person_named(std::string_view name) {
  if (!name.starts_with('P')) return std::nullopt;
  return parse_number<std::uint64_t>(name.substr(1));
}

/// The ids in the subjects' names, if every name has a different one; otherwise 1, 2, ... in the
/// order of the file.
std::vector<std::uint64_t> ids_of(const std::vector<motion::MarkerSubject>& subjects) {
  std::vector<std::uint64_t> ids;
  for (const auto& subject : subjects) {
    const auto id = person_named(subject.name);
    if (id && std::find(ids.begin(), ids.end(), *id) == ids.end()) ids.push_back(*id);
  }
  if (ids.size() == subjects.size()) return ids;
  ids.resize(subjects.size());
  std::iota(ids.begin(), ids.end(), std::uint64_t{1});
  return ids;
}

tl::unexpected<Error> without_joints(const Error& error, const std::string& origin) {
  const bool names = error.code == ErrorCode::Unsupported;
  return fail(error.code, origin, to_string(error) + (names ? kHowToName : ""));
}

/// Turns all joints, and multiplies their places.
void reshape(motion::Motion& motion, double factor, const Eigen::Matrix3d& turn) {
  const Eigen::Quaterniond rotation(turn);
  for (auto& body : motion.frames) {
    for (Joint& joint : body.joints) {
      joint.position = factor * (turn * joint.position);
      if (joint.orientation.norm() > 0.0) joint.orientation = rotation * joint.orientation;
    }
  }
}

Result<Captured> captured_points(motion::MarkerTracks& tracks, std::string device,
                                 const std::string& origin, const ImportOptions& options) {
  if (options.up) tracks.world_from_file = ours_from_up(*options.up);
  auto found = motion::motion_from_markers(tracks, options.joints);
  if (!found) return without_joints(found.error(), origin);
  Captured out{std::move(device), {}, ids_of(found->subjects)};
  for (auto& subject : found->subjects) out.persons.push_back(std::move(subject.motion));
  if (!found->unused_labels.empty())
    out.notes["labels"] =
        fmt::format("{} of {} points are no joint: {}", found->unused_labels.size(),
                    tracks.labels.size(), list_of(found->unused_labels));
  out.damage = tracks.notes;
  out.space.ours_from_file = tracks.world_from_file;
  return out;
}

Result<Captured> captured_c3d(const std::string& bytes, const std::string& origin,
                              const ImportOptions& options) {
  auto c3d = motion::parse_c3d(bytes, origin, options.metres_per_unit);
  if (!c3d) return pass(c3d);
  auto out = captured_points(*c3d, "C3D (" + c3d->processor + ")", origin, options);
  if (out) out->space.metres_per_unit = c3d->metres_per_unit;
  return out;
}

Result<Captured> captured_trc(const std::string& text, const std::string& origin,
                              const ImportOptions& options) {
  auto trc = motion::parse_trc(text, origin, options.metres_per_unit);
  if (!trc) return pass(trc);
  auto out = captured_points(*trc, "TRC", origin, options);
  if (out) out->space.metres_per_unit = trc->metres_per_unit;
  return out;
}

std::optional<double> stature_in(const motion::Motion& motion) {
  constexpr std::size_t kEnough = 500;
  std::vector<double> statures;
  for (std::size_t f = 0; f < motion.frames.size(); f += 1 + motion.frames.size() / kEnough) {
    if (const auto stature = motion::stature_of(motion.frames[f])) statures.push_back(*stature);
  }
  if (statures.empty()) return std::nullopt;
  return median(std::move(statures));
}

/// BVH states no unit: without --unit it is the centimetre, unless only another makes a person.
void settle_unit(Captured& out) {
  motion::Motion& motion = out.persons.front();
  const auto stature = stature_in(motion);
  if (!stature || *stature == 0.0 || motion::is_of_a_person(*stature)) return;
  const auto guess = motion::fitting_unit(*stature, out.space.metres_per_unit);
  if (!guess.named) return;
  const double factor = guess.metres / out.space.metres_per_unit;
  reshape(motion, factor, Eigen::Matrix3d::Identity());
  out.space.metres_per_unit = guess.metres;
  out.notes["unit"] = fmt::format(
      "the file states no unit; in cm people would be {:.2g} m tall, so --unit {} is assumed, "
      "which makes them {:.2g} m",
      *stature, guess.name, factor * *stature);
}

Result<Captured> captured_bvh(const std::string& text, const std::string& origin,
                              const ImportOptions& options) {
  const double unit = options.metres_per_unit.value_or(kCentimetre);
  const auto bvh = motion::parse_bvh(text, origin, unit);
  if (!bvh) return pass(bvh);
  auto motion = motion::motion_from_bvh(*bvh, options.joints);
  if (!motion) return without_joints(motion.error(), origin);
  Captured out{"BVH", {std::move(*motion)}, {1}};
  out.damage = bvh->notes;
  out.space.metres_per_unit = unit;
  if (!options.metres_per_unit) settle_unit(out);
  if (motion::Motion& only = out.persons.front(); motion::starts_with_pose(only)) {
    only.frames.erase(only.frames.begin());
    out.notes["repeated"] = "the first frame is a pose and no part of the motion, and was left out";
  }
  if (!options.up) return out;
  out.space.ours_from_file = ours_from_up(*options.up);
  reshape(out.persons.front(), 1.0, out.space.ours_from_file);
  return out;
}

Result<Captured> captured_htr(const std::string& text, const std::string& origin,
                              const ImportOptions& options) {
  const auto htr = motion::parse_htr(text, origin);
  if (!htr) return pass(htr);
  auto motion = motion::motion_from_bvh(*htr, options.joints);
  if (!motion) return without_joints(motion.error(), origin);
  Captured out{"Motion Analysis HTR", {std::move(*motion)}, {1}};
  out.damage = htr->notes;
  return out;
}

Result<Captured> captured_mvnx(const std::string& text, const std::string& origin,
                               const ImportOptions& options) {
  const auto mvnx = motion::parse_mvnx(text, origin);
  if (!mvnx) return pass(mvnx);
  auto motion = motion::motion_from_mvnx(*mvnx);
  if (!motion) return fail(motion.error().code, origin, to_string(motion.error()));
  Captured out{"Xsens MVN (MVNX)", {std::move(*motion)}, {1}};
  if (!mvnx->sensors.empty())
    out.notes["sensors"] =
        fmt::format("orientations of {} inertial sensors are not kept", mvnx->sensors.size());
  if (mvnx->fingers) out.notes["fingers"] = "the file has finger tracking: fingers are not kept";
  out.space.metres_per_unit = options.metres_per_unit.value_or(1.0);
  const UpAxis z{2, false};  // as the format has it
  const UpAxis up = options.up.value_or(z);
  reshape(out.persons.front(), out.space.metres_per_unit,
          ours_from_up(up) * ours_from_up(z).transpose());
  out.space.ours_from_file = ours_from_up(up);
  return out;
}

using Reader = Result<Captured> (*)(const std::string&, const std::string&, const ImportOptions&);
constexpr std::array<std::pair<MotionFormat, Reader>, 5> kMotionReaders{
    {{MotionFormat::C3d, &captured_c3d},
     {MotionFormat::Trc, &captured_trc},
     {MotionFormat::Bvh, &captured_bvh},
     {MotionFormat::Htr, &captured_htr},
     {MotionFormat::Mvnx, &captured_mvnx}}};

/// The names of points or joints in a file.
Result<std::vector<std::string>> names_in_file(const std::string& text, const std::string& origin,
                                               MotionFormat format) {
  if (format == MotionFormat::C3d) {
    return motion::parse_c3d(text, origin, 1.0).map([](const auto& c3d) { return c3d.labels; });
  }
  if (format == MotionFormat::Trc) {
    return motion::parse_trc(text, origin, 1.0).map([](const auto& trc) { return trc.labels; });
  }
  if (format == MotionFormat::Bvh) {
    return motion::parse_bvh(text, origin).map([](const auto& bvh) { return names_in(bvh); });
  }
  if (format == MotionFormat::Htr) {
    return motion::parse_htr(text, origin).map([](const auto& htr) { return names_in(htr); });
  }
  return fail(ErrorCode::Unsupported, origin, "has segments of fixed names");
}

}  // namespace

Result<Captured> read_captured(const std::filesystem::path& file, MotionFormat format,
                               const ImportOptions& options) {
  const auto bytes = read_bounded(file, options.limits.max_text_bytes);
  if (!bytes) return pass(bytes);
  const auto* const row = std::find_if(kMotionReaders.begin(), kMotionReaders.end(),
                                       [&](const auto& each) { return each.first == format; });
  return row->second(*bytes, file.string(), options);
}

Result<std::string> joint_template(const std::filesystem::path& file, MotionFormat format) {
  const auto bytes = read_bounded(file, ImportLimits{}.max_text_bytes);
  if (!bytes) return pass(bytes);
  const auto names = names_in_file(*bytes, file.string(), format);
  if (!names) return pass(names);
  const auto dialect = format == MotionFormat::Bvh || format == MotionFormat::Htr
                           ? motion::Dialect::Joints
                           : motion::Dialect::JointsAndMarkers;
  return motion::joint_choice_template(*names, motion::joint_sources(*names, dialect));
}

}  // namespace chorus::importers
