#include "common/alignment/marked_points.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/parse.h"
#include "common/geometry/rigid_fit.h"
#include "common/geometry/rotation.h"

namespace chorus::alignment {
namespace {

constexpr double kFarthest = 1000.0;  // [m], the limit that the server has
constexpr double kBeside = 0.1;       // [m] from the line to the front

Eigen::Vector3d on_floor(const Eigen::Vector2d& place) { return {place.x(), 0.0, place.y()}; }

std::vector<double> distances(std::span<const FloorMark> marks,
                              const Eigen::Isometry3d& now_from_new) {
  std::vector<double> off;
  for (const FloorMark& mark : marks)
    off.push_back((now_from_new * on_floor(mark.shall) - on_floor(mark.now)).norm());
  return off;
}

/// Between the two of them that are farthest from each other.
double reach_of(std::span<const FloorMark> marks, Eigen::Vector2d FloorMark::*place) {
  double most = 0.0;
  for (const FloorMark& one : marks) {
    for (const FloorMark& other : marks) most = std::max(most, (one.*place - other.*place).norm());
  }
  return most;
}

struct Fitted {
  Eigen::Isometry3d now_from_new;
  std::vector<double> off;
};

std::optional<Fitted> fit(std::span<const FloorMark> marks) {
  std::vector<Eigen::Vector3d> shall;
  std::vector<Eigen::Vector3d> now;
  for (const FloorMark& mark : marks) {
    shall.push_back(on_floor(mark.shall));
    now.push_back(on_floor(mark.now));
  }
  const auto found = fit_yaw(shall, now);
  if (!found) return std::nullopt;
  return Fitted{found->target_from_source, distances(marks, found->target_from_source)};
}

/// True if the marks fit once left and right of the new world are exchanged.
bool fits_mirrored(std::span<const FloorMark> marks) {
  std::vector<FloorMark> mirrored(marks.begin(), marks.end());
  for (FloorMark& mark : mirrored) mark.shall.x() = -mark.shall.x();
  const auto found = fit(mirrored);
  return found && std::ranges::max(found->off) <= kMostOff;
}

tl::unexpected<Error> do_not_fit(std::span<const FloorMark> marks, const std::vector<double>& off) {
  const auto worst = std::ranges::max_element(off);
  std::string text =
      fmt::format("the marks do not fit together: mark {} would be {:.2f} m from where it shall be",
                  worst - off.begin() + 1, *worst);
  if (fits_mirrored(marks)) {
    text += "; they fit with left and right exchanged: +x is on the left of who faces +z";
  } else if (marks.size() == 2) {
    text += fmt::format("; they are {:.2f} m apart and shall be {:.2f} m apart",
                        reach_of(marks, &FloorMark::now), reach_of(marks, &FloorMark::shall));
  }
  return fail(ErrorCode::Conflict, "origin", std::move(text));
}

tl::unexpected<Error> too_near() {
  return fail(ErrorCode::InvalidArgument, "origin",
              fmt::format("the marks are too near together to tell a direction: at least {} m "
                          "apart; 2 m or more are better",
                          kLeastApart));
}

Result<double> coordinate(std::string_view text) {
  const auto value = parse_finite(text);
  if (!value || !(std::abs(*value) <= kFarthest))
    return fail(ErrorCode::InvalidArgument, "origin",
                fmt::format("\"{}\" is not a number from -1000 to 1000 [m]", text));
  return *value;
}

}  // namespace

Result<MarkedOrigin> origin_from_marks(std::span<const FloorMark> marks) {
  if (marks.size() < 2)
    return fail(ErrorCode::InvalidArgument, "origin", "two marks or more are needed");
  MarkedOrigin out;
  out.apart = reach_of(marks, &FloorMark::now);
  if (out.apart < kLeastApart || reach_of(marks, &FloorMark::shall) < kLeastApart)
    return too_near();
  auto found = fit(marks);
  if (!found) return too_near();
  if (std::ranges::max(found->off) > kMostOff) return do_not_fit(marks, found->off);
  const Eigen::Vector3d place = found->now_from_new.translation();
  out.origin = {place.x(), place.z(), yaw_of(found->now_from_new.linear())};
  out.off = std::move(found->off);
  return out;
}

Result<MarkedOrigin> origin_from_axes(const Eigen::Vector2d& origin, const Eigen::Vector2d& ahead,
                                      const std::optional<Eigen::Vector2d>& left) {
  const Eigen::Vector2d front = ahead - origin;
  if (front.norm() < kLeastApart || (left && (*left - origin).norm() < kLeastApart))
    return too_near();
  MarkedOrigin out;
  out.origin = {origin.x(), origin.y(), std::atan2(front.x(), front.y())};
  out.off = {0.0, 0.0};
  out.apart = front.norm();
  if (!left) return out;
  // The left of the front (sin, cos) in (x, z) is (cos, -sin).
  const Eigen::Vector2d to_left = Eigen::Vector2d(front.y(), -front.x()).normalized();
  const double beside = to_left.dot(*left - origin);
  if (beside > kBeside) return out;
  return fail(ErrorCode::Conflict, "origin",
              beside < -kBeside
                  ? "the third mark is on the right of who looks from the first to the second; it "
                    "shall be on the left (+x): were two of them exchanged?"
                  : "the third mark is on the line through the first two; it shall be on the left "
                    "of it (+x)");
}

Result<Eigen::Vector2d> read_place(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos)
    return fail(ErrorCode::InvalidArgument, "origin",
                fmt::format("\"{}\" is not a place such as 0.5,-2 (x and z in metres)", text));
  const auto x = coordinate(text.substr(0, comma));
  const auto z = coordinate(text.substr(comma + 1));
  if (!x) return pass(x);
  if (!z) return pass(z);
  return Eigen::Vector2d(*x, *z);
}

Result<FloorMark> read_mark(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos)
    return fail(ErrorCode::InvalidArgument, "origin",
                fmt::format("\"{}\" is not a mark such as 0.1,2.3=0,0: where it is now, and where "
                            "it shall be",
                            text));
  const auto now = read_place(text.substr(0, equals));
  const auto shall = read_place(text.substr(equals + 1));
  if (!now) return pass(now);
  if (!shall) return pass(shall);
  return FloorMark{*now, *shall};
}

}  // namespace chorus::alignment
