#include "services/ctl/evaluate/reference_take.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>

#include "common/base/file.h"
#include "common/base/median.h"
#include "common/base/unit_name.h"
#include "common/body/located.h"
#include "common/evaluation/limb_frame.h"
#include "common/evaluation/referee.h"
#include "services/ctl/evaluate/compared_source.h"
#include "services/ctl/line/text_file.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMostJointBytes = 1u << 20;
constexpr std::size_t kFewestJoints = 3;
// Markers and trackers place joints differently, and so bones are up to a quarter longer or
// shorter; the nearest mistake of a unit, inches for centimetres, is a factor of 2.5.
constexpr double kMostScale = 1.6;

Result<importers::ImportOptions> import_options(const ReferenceFile& source) {
  importers::ImportOptions options;
  if (!source.unit.empty()) {
    options.metres_per_unit = unit_or_factor(source.unit);
    if (!options.metres_per_unit)
      return fail(
          ErrorCode::InvalidArgument, "--reference-unit",
          "\"" + source.unit + "\" is neither a unit (mm, cm, m, in) nor a number of metres");
  }
  if (source.joints.empty()) return options;
  const auto text = read_file(source.joints, kMostJointBytes);
  if (!text) return pass(text);
  auto joints = motion::parse_joint_choice(*text, source.joints);
  if (!joints) return pass(joints);
  options.joints = std::move(*joints);
  return options;
}

/// Writes a file in which the reader says which points are which joints; "" if there is none.
std::string written_template(const ReferenceFile& source, importers::MotionFormat format) {
  const auto text = importers::joint_template(source.file, format);
  if (!text) return {};
  namespace fs = std::filesystem;
  std::error_code failed;
  fs::create_directories(source.out, failed);
  const fs::path file =
      fs::path(source.out) / (fs::path(source.file).stem().string() + ".joints.txt");
  return write_text(file.string(), *text) ? file.string() : std::string();
}

/// Says where names can be given, where the file's are not enough.
Error with_template(Error error, const ReferenceFile& source) {
  const auto format = motion_format(source.file);
  if (!format || !source.joints.empty()) return error;
  const std::string file = written_template(source, *format);
  error.message.resize(
      std::min(error.message.size(), error.message.find("; say which makes which")));
  if (!file.empty())
    error.message += fmt::format(
        "; {} lists the file's names: fill it in, and add --reference-joints {}", file, file);
  return error;
}

/// Importers name the option of their own command.
Error with_our_option(Error error) {
  constexpr std::string_view kTheirs = "--unit";
  const std::size_t at = error.message.find(kTheirs);
  if (at != std::string::npos) error.message.replace(at, kTheirs.size(), "--reference-unit");
  return error;
}

Result<ComparedSource> read_source(const ReferenceFile& source) {
  const auto format = motion_format(source.file);
  if (!format && !source.unit.empty())
    return fail(ErrorCode::InvalidArgument, "--reference-unit",
                "is for motion files; fused frames are in metres: leave it out");
  if (!format) return read_compared(source.file, 0.0);
  const auto options = import_options(source);
  if (!options) return pass(options);
  auto read = read_motion(source.file, *format, *options);
  if (read) return read;
  if (read.error().code == ErrorCode::Unsupported)
    return tl::unexpected(with_template(with_our_option(read.error()), source));
  return tl::unexpected(with_our_option(read.error()));
}

/// Times from 0, so that a shift is a number that says something.
void count_from_zero(comparison::People& people) {
  double first = std::numeric_limits<double>::infinity();
  for (const auto& [id, track] : people)
    for (const auto& moment : track) first = std::min(first, moment.time);
  for (auto& [id, track] : people)
    for (auto& moment : track) moment.time -= first;
}

std::array<bool, kJointCount> ever_seen(const comparison::Track& track) {
  std::array<bool, kJointCount> out{};
  for (const auto& moment : track) {
    const Located points = points_of(moment.body);
    for (std::size_t j = 0; j < kJointCount; ++j) out[j] = out[j] || points[j].has_value();
  }
  return out;
}

std::size_t common_joints(const comparison::Track& one, const comparison::Track& other) {
  const auto a = ever_seen(one);
  const auto b = ever_seen(other);
  std::size_t count = 0;
  for (std::size_t j = 0; j < kJointCount; ++j) count += a[j] && b[j] ? 1 : 0;
  return count;
}

/// Somebody of the reference, and when they move as the tracker's person does.
struct Candidate {
  const comparison::Track* track;
  evaluation::TrackedBody body;
  evaluation::TimeShift shift;
};

Result<Candidate> best_candidate(const comparison::People& people,
                                 const comparison::Track& tracked) {
  const evaluation::TrackedBody ours = limbs_of(tracked);
  std::optional<Candidate> best;
  tl::unexpected<Error> refusal = fail(ErrorCode::NotFound, "reference", "shows nobody");
  for (const auto& [id, track] : people) {
    Candidate one{&track, limbs_of(track), {}};
    const auto shift = evaluation::reference_shift(ours, one.body);
    if (!shift) {
      refusal = pass(shift);
      continue;
    }
    one.shift = *shift;
    if (!best || one.shift.correlation > best->shift.correlation) best = std::move(one);
  }
  if (!best) return refusal;
  return std::move(*best);
}

/// The usual length of each limb's bone [m]; none where it is not shown.
std::array<std::optional<double>, inertial::kLimbCount> bone_lengths(
    const comparison::Track& track) {
  std::array<std::optional<double>, inertial::kLimbCount> out;
  for (std::size_t i = 0; i < inertial::kLimbCount; ++i) {
    const auto bone = evaluation::bone_of(static_cast<inertial::Limb>(i));
    std::vector<double> lengths;
    for (const auto& moment : track) {
      const Joint& from = moment.body[bone.from];
      const Joint& to = moment.body[bone.to];
      if (from.seen() && to.seen()) lengths.push_back((to.position - from.position).norm());
    }
    if (!lengths.empty()) out[i] = median(std::move(lengths));
  }
  return out;
}

/// Refuses bones that are of another length than the tracker's: a wrong unit.
Result<void> check_scale(const comparison::Track& tracked, const comparison::Track& reference) {
  const auto ours = bone_lengths(tracked);
  const auto theirs = bone_lengths(reference);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < inertial::kLimbCount; ++i)
    if (ours[i] && theirs[i] && *ours[i] > 0.0) ratios.push_back(*theirs[i] / *ours[i]);
  if (ratios.empty()) return {};
  const double scale = median(std::move(ratios));
  if (scale <= kMostScale && scale >= 1.0 / kMostScale) return {};
  return fail(ErrorCode::Conflict, "reference",
              fmt::format("has bones {:.3g} times as long as the tracker's: are its lengths in "
                          "another unit than it says? --reference-unit says which",
                          scale));
}

double rms_of(const comparison::PairComparison& pair) {
  double sum = 0.0, count = 0.0;
  for (const auto& joint : pair.joints) {
    if (!joint) continue;
    sum += joint->rms * joint->rms;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

/// Brings the reference's person into the tracker's time and world.
Result<ReferenceTake> placed(Candidate candidate, const comparison::Track& tracked) {
  if (auto ok = check_scale(tracked, *candidate.track); !ok) return pass(ok);
  comparison::Track moved = *candidate.track;
  for (auto& moment : moved) moment.time += candidate.shift.shift;
  comparison::CompareOptions options;
  options.same_clock = true;
  options.other_world = true;
  const auto compared = comparison::compare({{1, tracked}}, {{1, moved}}, options);
  if (!compared) return fail(compared.error().code, "reference", compared.error().message);
  ReferenceTake out{std::move(candidate.body),       {}, candidate.shift, 0,
                    rms_of(compared->pairs.front()), {}};
  const Eigen::Quaterniond turn(compared->a_from_b.linear());
  for (auto& [limb, track] : out.body) {
    for (auto& each : track) {
      each.time += candidate.shift.shift;
      each.value.world_from_limb = turn * each.value.world_from_limb;
    }
  }
  for (auto& moment : moved)
    for (Joint& joint : moment.body.joints) joint.position = compared->a_from_b * joint.position;
  out.places = places_of(moved);
  return out;
}

}  // namespace

evaluation::TrackedBody limbs_of(const comparison::Track& track) {
  evaluation::TrackedBody out;
  for (const auto& moment : track) {
    for (std::size_t i = 0; i < inertial::kLimbCount; ++i) {
      const auto limb = static_cast<inertial::Limb>(i);
      if (const auto seen = evaluation::limb_from_joints(moment.body, limb))
        out[limb].push_back({moment.time, *seen});
    }
  }
  return out;
}

evaluation::BodyTrack places_of(const comparison::Track& track) {
  evaluation::BodyTrack out;
  out.reserve(track.size());
  for (const auto& moment : track) out.push_back({moment.time, moment.body});
  return out;
}

Result<ReferenceTake> read_reference(const ReferenceFile& source,
                                     const comparison::Track& tracked) {
  auto read = read_source(source);
  if (!read) return pass(read);
  count_from_zero(read->people);
  std::size_t joints = 0;
  for (const auto& [id, track] : read->people)
    joints = std::max(joints, common_joints(track, tracked));
  if (joints < kFewestJoints)
    return tl::unexpected(
        with_template({ErrorCode::NotFound, source.file,
                       fmt::format("shows {} joints that the tracker shows, too; {} are needed",
                                   joints, kFewestJoints)},
                      source));
  auto candidate = best_candidate(read->people, tracked);
  if (!candidate) return fail(candidate.error().code, source.file, candidate.error().message);
  auto out = placed(std::move(*candidate), tracked);
  if (!out) return fail(out.error().code, source.file, out.error().message);
  out->joints = joints;
  out->notes = std::move(read->notes);
  return out;
}

}  // namespace chorus::ctl
