// The table that says which points of a C3D file make which Kinect v2 joint.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/body/bones.h"
#include "common/motion/c3d.h"
#include "common/motion/text_lines.h"

namespace chorus::motion {
namespace {

struct LabelRow {
  JointId left;  ///< For a joint without sides, the joint itself.
  JointId right;
  JointState state;                          ///< Inferred for skin markers.
  std::array<std::string_view, 4> labels{};  ///< The joint is their mean; '<' stands for L or R.
};

// The rows are in order of preference: a joint uses the first of its rows whose labels are all
// present.  Our own names come first, then joint centres as OpenSim users name them, the segment
// origins of Plug-in Gait, and the skin markers of the Plug-in Gait set.
constexpr auto kSure = JointState::Tracked;
constexpr auto kGuess = JointState::Inferred;
// clang-format off
constexpr LabelRow kLabelRows[] = {
    {JointId::HipLeft, JointId::HipRight, kSure, {"<HJC"}},
    {JointId::HipLeft, JointId::HipRight, kSure, {"<FEP"}},
    {JointId::KneeLeft, JointId::KneeRight, kSure, {"<KJC"}},
    {JointId::KneeLeft, JointId::KneeRight, kSure, {"<FEO"}},
    {JointId::KneeLeft, JointId::KneeRight, kGuess, {"<LFC", "<MFC"}},
    {JointId::KneeLeft, JointId::KneeRight, kGuess, {"<KNE", "<KNM"}},
    {JointId::KneeLeft, JointId::KneeRight, kGuess, {"<KNE"}},
    {JointId::AnkleLeft, JointId::AnkleRight, kSure, {"<AJC"}},
    {JointId::AnkleLeft, JointId::AnkleRight, kSure, {"<TIO"}},
    {JointId::AnkleLeft, JointId::AnkleRight, kGuess, {"<LMAL", "<MMAL"}},
    {JointId::AnkleLeft, JointId::AnkleRight, kGuess, {"<ANK"}},
    {JointId::FootLeft, JointId::FootRight, kGuess, {"<TOE"}},
    {JointId::FootLeft, JointId::FootRight, kGuess, {"<MT1", "<MT2"}},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kSure, {"<SJC"}},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kSure, {"<CLO"}},
    {JointId::ShoulderLeft, JointId::ShoulderRight, kGuess, {"<SHO"}},
    {JointId::ElbowLeft, JointId::ElbowRight, kSure, {"<EJC"}},
    {JointId::ElbowLeft, JointId::ElbowRight, kSure, {"<HUO"}},
    {JointId::ElbowLeft, JointId::ElbowRight, kGuess, {"<ELB"}},
    {JointId::WristLeft, JointId::WristRight, kSure, {"<WJC"}},
    {JointId::WristLeft, JointId::WristRight, kSure, {"<RAO"}},
    {JointId::WristLeft, JointId::WristRight, kGuess, {"<WRA", "<WRB"}},
    {JointId::HandLeft, JointId::HandRight, kSure, {"<HNO"}},
    {JointId::HandLeft, JointId::HandRight, kGuess, {"<FIN"}},
    {JointId::SpineBase, JointId::SpineBase, kSure, {"MIDPEL"}},
    {JointId::SpineBase, JointId::SpineBase, kSure, {"LHJC", "RHJC"}},
    {JointId::SpineBase, JointId::SpineBase, kSure, {"LFEP", "RFEP"}},
    {JointId::SpineBase, JointId::SpineBase, kSure, {"HipLeft", "HipRight"}},
    {JointId::SpineBase, JointId::SpineBase, kGuess, {"LASI", "RASI", "LPSI", "RPSI"}},
    {JointId::SpineMid, JointId::SpineMid, kGuess, {"STRN", "T10"}},
    {JointId::SpineShoulder, JointId::SpineShoulder, kGuess, {"CLAV", "C7"}},
    {JointId::Neck, JointId::Neck, kGuess, {"C7"}},
    {JointId::Head, JointId::Head, kSure, {"HEDO"}},
    {JointId::Head, JointId::Head, kGuess, {"LFHD", "RFHD", "LBHD", "RBHD"}},
};
// clang-format on

constexpr std::size_t kFewestJoints = 2;
constexpr std::size_t kShownLabels = 12;
// The limit for all subjects together, which then need about 1 GB.
constexpr std::size_t kMaxSkeletons = 2 * kMaxFrames;

/// The index of each point, by its label without the subject.
using Labels = std::map<std::string, std::size_t>;

struct PointSource {
  std::vector<std::size_t> points;  ///< Empty if the file lacks such labels.
  JointState state = JointState::NotTracked;
};
using PointSources = std::array<PointSource, kJointCount>;

PointSource source_of(const Labels& labels, const LabelRow& row, std::string_view side) {
  PointSource source{{}, row.state};
  for (const std::string_view each : row.labels) {
    if (each.empty()) break;
    std::string wanted(each);
    if (wanted.front() == '<') wanted.replace(0, 1, side);
    const auto found = labels.find(wanted);
    if (found == labels.end()) return {};
    source.points.push_back(found->second);
  }
  return source;
}

PointSources sources_of(const Labels& labels) {
  PointSources sources;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto own = labels.find(std::string(kJointNames[j]));
    if (own != labels.end()) sources[j] = {{own->second}, JointState::Tracked};
  }
  for (const LabelRow& row : kLabelRows) {
    for (const auto& [joint, side] : {std::pair{row.left, "L"}, std::pair{row.right, "R"}}) {
      PointSource& source = sources[index_of(joint)];
      if (source.points.empty()) source = source_of(labels, row, side);
    }
  }
  return sources;
}

Skeleton<WorldSpace> skeleton_of(const C3d& c3d, const std::vector<C3dPoint>& frame,
                                 const PointSources& sources) {
  Skeleton<WorldSpace> body;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const PointSource& source = sources[j];
    const bool there =
        !source.points.empty() && std::all_of(source.points.begin(), source.points.end(),
                                              [&](std::size_t p) { return frame[p].valid(); });
    if (!there) continue;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const std::size_t p : source.points) mean += frame[p].position.cast<double>();
    body.joints[j].position =
        c3d.world_from_file * mean / static_cast<double>(source.points.size());
    body.joints[j].state = source.state;
  }
  orient_segments(body);
  return body;
}

std::string labels_shown(const C3d& c3d) {
  std::string text;
  for (std::size_t i = 0; i < std::min(kShownLabels, c3d.labels.size()); ++i)
    text += (i == 0 ? "" : " ") + c3d.labels[i].substr(0, 24);
  return c3d.labels.size() > kShownLabels ? text + " ..." : text;
}

/// Points by subject and label; the subjects in the order of the file.
std::vector<std::pair<std::string, Labels>> subjects_of(const C3d& c3d) {
  std::vector<std::pair<std::string, Labels>> subjects;
  std::map<std::string, std::size_t> known;
  for (std::size_t p = 0; p < c3d.labels.size(); ++p) {
    const std::string& label = c3d.labels[p];
    const std::size_t colon = label.find(':');
    const bool prefixed = colon != std::string::npos;
    const std::string name = prefixed ? label.substr(0, colon) : "";
    const auto [at, fresh] = known.emplace(name, subjects.size());
    if (fresh) subjects.emplace_back(name, Labels{});
    subjects[at->second].second.emplace(prefixed ? label.substr(colon + 1) : label, p);
  }
  return subjects;
}

Motion motion_of(const C3d& c3d, const PointSources& sources) {
  Motion motion{c3d.rate_hz, {}};
  motion.frames.reserve(c3d.frames.size());
  for (const auto& frame : c3d.frames) motion.frames.push_back(skeleton_of(c3d, frame, sources));
  return motion;
}

}  // namespace

Result<C3dMotion> motion_from_c3d(const C3d& c3d) {
  C3dMotion out;
  std::set<std::size_t> used;
  for (const auto& [name, labels] : subjects_of(c3d)) {
    const PointSources sources = sources_of(labels);
    const auto found = std::count_if(sources.begin(), sources.end(),
                                     [](const PointSource& s) { return !s.points.empty(); });
    if (found < static_cast<std::ptrdiff_t>(kFewestJoints)) continue;
    if ((out.subjects.size() + 1) * c3d.frames.size() > kMaxSkeletons)
      return fail(ErrorCode::TooLarge, "C3D labels", "too many subjects for a file this long");
    for (const PointSource& source : sources)
      used.insert(source.points.begin(), source.points.end());
    out.subjects.push_back({name, motion_of(c3d, sources)});
  }
  if (out.subjects.empty())
    return fail(ErrorCode::Unsupported, "C3D labels",
                "none of the points is a joint we know; the labels are: " + labels_shown(c3d));
  for (std::size_t p = 0; p < c3d.labels.size(); ++p) {
    if (used.count(p) == 0) out.unused_labels.push_back(c3d.labels[p]);
  }
  return out;
}

}  // namespace chorus::motion
