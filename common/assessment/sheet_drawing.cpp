#include "common/assessment/sheet_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/body/bones.h"
#include "common/report/html.h"

namespace chorus::assessment {
namespace {

using Eigen::Vector3d;
using enum JointId;

constexpr double kFigureWidth = 150.0;   // [px]
constexpr double kFigureHeight = 220.0;  // [px]
constexpr double kPixelsPerMetre = 100.0;
constexpr double kTimelineWidth = 760.0;
constexpr double kTimelineHeight = 150.0;
constexpr double kMargin = 28.0;

/// The horizontal axis of the picture.
Vector3d axis_of(const Skeleton<WorldSpace>& body, View view) {
  Vector3d left = Vector3d::UnitX();
  if (body[HipLeft].seen() && body[HipRight].seen())
    left = body[HipLeft].position - body[HipRight].position;
  left.y() = 0.0;
  if (!(left.norm() > 1e-6)) left = Vector3d::UnitX();
  left.normalize();
  // From in front, the person's left is on the right; from the left, they look to the left.
  return view == View::Front ? left : Vector3d(-left.cross(Vector3d::UnitY()));
}

bool of_left(JointId id) { return name_of(id).find("Left") != std::string_view::npos; }

Vector3d middle_of_body(const Skeleton<WorldSpace>& body) {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (const Joint& joint : body.joints) {
    if (!joint.seen()) continue;
    sum += joint.position;
    count += 1.0;
  }
  return count > 0.0 ? Vector3d(sum / count) : sum;
}

/// A line at the lower end of each level, with its score where there is room for it.
template <class Height>
std::string level_lines(const ergonomics::Method& method, const Height& y) {
  std::string svg;
  constexpr double kTextHeight = 10.0;
  double written = std::numeric_limits<double>::infinity();
  for (const auto& level : method.levels) {
    const double at = y(level.from - 0.5);
    const bool room = written - at >= kTextHeight;
    if (room) written = at;
    svg += fmt::format("<line x1=\"{0}\" x2=\"{1}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" class=\"grid\"/>",
                       kMargin, kTimelineWidth - kMargin, at);
    if (room) svg += fmt::format("<text x=\"2\" y=\"{:.1f}\">{}</text>", at, level.from);
  }
  return svg;
}

std::string without_score(double x, double width) {
  return fmt::format("<rect x=\"{:.1f}\" y=\"8\" width=\"{:.2f}\" height=\"{}\" class=\"none\"/>",
                     x, width + 0.1, kTimelineHeight - 30);
}

std::string timeline_head(const std::string& label) {
  return fmt::format(
      "<svg viewBox=\"0 0 {} {}\" class=\"timeline\" role=\"img\" aria-label=\"{}\">",
      kTimelineWidth, kTimelineHeight, report::escaped(label));
}

/// Where the timeline begins and ends.
std::string time_labels(double from, double lasts) {
  const int digits = lasts < 20.0 ? 1 : 0;
  return fmt::format(
      "<text x=\"{}\" y=\"{}\">{:.{}f} s</text><text x=\"{}\" y=\"{}\" "
      "text-anchor=\"end\">{:.{}f} s</text>",
      kMargin, kTimelineHeight - 6, from, digits, kTimelineWidth - kMargin, kTimelineHeight - 6,
      from + lasts, digits);
}

}  // namespace

std::string stick_figure(const Skeleton<WorldSpace>& body, View view) {
  const Vector3d axis = axis_of(body, view);
  const Vector3d middle = middle_of_body(body);
  const auto x = [&](JointId id) {
    return kFigureWidth / 2 + kPixelsPerMetre * axis.dot(body[id].position - middle);
  };
  const auto y = [&](JointId id) {
    return kFigureHeight - 10 - kPixelsPerMetre * body[id].position.y();
  };
  std::string svg = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\"><line x1=\"0\" "
      "x2=\"{0}\" y1=\"{2}\" y2=\"{2}\" class=\"floor\"/>",
      kFigureWidth, kFigureHeight, kFigureHeight - 10);
  for (const Bone& bone : kBones) {
    if (!body[bone.parent].seen() || !body[bone.child].seen()) continue;
    svg +=
        fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" class=\"{}\"/>",
                    x(bone.parent), y(bone.parent), x(bone.child), y(bone.child),
                    of_left(bone.child) ? "bone left" : "bone");
  }
  if (body[Head].seen())
    svg += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"9\" class=\"head\"/>", x(Head),
                       y(Head));
  return svg + "</svg>";
}

std::string score_timeline(const ergonomics::ScoredPerson& person, std::size_t method,
                           const std::string& label) {
  const ergonomics::MethodSummary& summary = person.methods[method];
  const int highest = summary.method->highest;
  const double from = person.instants.empty() ? 0.0 : person.instants.front().at;
  const double span = std::max(person.seconds, 1e-3);
  const auto x = [&](double at) {
    return kMargin + (kTimelineWidth - 2 * kMargin) * (at - from) / span;
  };
  const auto y = [&](double score) {
    return kTimelineHeight - 22 - (kTimelineHeight - 34) * (score - 0.5) / highest;
  };
  std::string svg = timeline_head(label) + level_lines(*summary.method, y);
  const double step = (kTimelineWidth - 2 * kMargin) /
                      static_cast<double>(std::max<std::size_t>(person.instants.size(), 1));
  std::string line;
  for (const auto& instant : person.instants) {
    const auto& score = instant.scores[method];
    if (!score.known()) {
      svg += without_score(x(instant.at), step);
      line += line.empty() || line.back() == ' ' ? "" : " ";
      continue;
    }
    const auto set = set_of(score, 0.9);
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.1f}\" "
        "class=\"set\"/>",
        x(instant.at), y(set.to + 0.5), std::min(step, kTimelineWidth - kMargin - x(instant.at)),
        y(set.from - 0.5) - y(set.to + 0.5));
    line += fmt::format("{}{:.1f},{:.1f}", line.empty() || line.back() == ' ' ? "M" : "L",
                        x(instant.at), y(score.score.high));
  }
  svg += fmt::format("<path d=\"{}\" class=\"score\"/>", line);
  for (std::size_t w = 0; w < summary.worst.size(); ++w)
    svg += fmt::format("<text x=\"{:.1f}\" y=\"10\" class=\"worst\">{}</text>",
                       x(summary.worst[w].at) - 3, w + 1);
  return svg + time_labels(from, person.seconds) + "</svg>";
}

}  // namespace chorus::assessment
