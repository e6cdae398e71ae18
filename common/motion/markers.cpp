#include "common/motion/markers.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "common/motion/infer_joints.h"
#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

constexpr std::size_t kFewestJoints = 2;
// The limit for all subjects together, which then need about 1 GB.
constexpr std::size_t kMaxSkeletons = 2 * kMaxFrames;

/// The points of one person: their labels without the subject, and their indices in the file.
struct Subject {
  std::string name;
  std::vector<std::string> labels = {};
  std::vector<std::size_t> points = {};
  JointSources sources = {};
};

/// Points by what stands before the separator in their labels; the subjects in the order of the
/// file.
std::vector<Subject> subjects_by(char separator, const MarkerTracks& tracks,
                                 const JointChoice& chosen) {
  std::vector<Subject> subjects;
  std::map<std::string, std::size_t> known;
  for (std::size_t p = 0; p < tracks.labels.size(); ++p) {
    const std::string& label = tracks.labels[p];
    const std::size_t end = label.find(separator);
    const bool prefixed = end != std::string::npos;
    const std::string name = prefixed ? label.substr(0, end) : "";
    const auto [at, fresh] = known.emplace(name, subjects.size());
    if (fresh) subjects.push_back({name});
    subjects[at->second].labels.push_back(prefixed ? label.substr(end + 1) : label);
    subjects[at->second].points.push_back(p);
  }
  for (Subject& subject : subjects)
    subject.sources = joint_sources(subject.labels, Dialect::JointsAndMarkers, chosen);
  return subjects;
}

std::size_t most_joints(const std::vector<Subject>& subjects) {
  std::size_t most = 0;
  for (const Subject& subject : subjects) most = std::max(most, count_found(subject.sources));
  return most;
}

std::vector<Subject> subjects_of(const MarkerTracks& tracks, const JointChoice& chosen) {
  auto by_colon = subjects_by(':', tracks, chosen);
  auto by_underscore = subjects_by('_', tracks, chosen);
  return most_joints(by_underscore) > most_joints(by_colon) ? by_underscore : by_colon;
}

Skeleton<WorldSpace> skeleton_of(const MarkerTracks& tracks, const std::vector<MarkerPoint>& frame,
                                 const Subject& subject) {
  Skeleton<WorldSpace> body;
  JointsThere there{};
  std::vector<Eigen::Vector3d> places;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const JointSource& source = subject.sources[j];
    there[j] = !source.points.empty();
    places.clear();
    for (const std::size_t p : source.points) {
      const MarkerPoint& point = frame[subject.points[p]];
      if (point.valid()) places.push_back(tracks.world_from_file * point.position.cast<double>());
    }
    if (places.empty() || places.size() < source.points.size()) continue;
    body.joints[j].position = source.placed(places);
    body.joints[j].state = source.state;
  }
  infer_absent(body, there);
  orient_segments(body);
  return body;
}

Motion motion_of(const MarkerTracks& tracks, const Subject& subject) {
  Motion motion{tracks.rate_hz, {}, tracks.times};
  motion.frames.reserve(tracks.frames.size());
  for (const auto& frame : tracks.frames)
    motion.frames.push_back(skeleton_of(tracks, frame, subject));
  return motion;
}

}  // namespace

Result<MarkerMotion> motion_from_markers(const MarkerTracks& tracks, const JointChoice& chosen) {
  MarkerMotion out;
  std::set<std::size_t> used;
  for (const Subject& subject : subjects_of(tracks, chosen)) {
    if (count_found(subject.sources) < kFewestJoints) continue;
    if ((out.subjects.size() + 1) * tracks.frames.size() > kMaxSkeletons)
      return fail(ErrorCode::TooLarge, "labels", "too many subjects for a file this long");
    for (const JointSource& source : subject.sources) {
      for (const std::size_t p : source.points) used.insert(subject.points[p]);
    }
    out.subjects.push_back({subject.name, motion_of(tracks, subject)});
  }
  if (out.subjects.empty())
    return fail(
        ErrorCode::Unsupported, "labels",
        "none of the points is a joint we know; the labels are: " + names_shown(tracks.labels));
  for (std::size_t p = 0; p < tracks.labels.size(); ++p) {
    if (!used.contains(p)) out.unused_labels.push_back(tracks.labels[p]);
  }
  return out;
}

}  // namespace chorus::motion
