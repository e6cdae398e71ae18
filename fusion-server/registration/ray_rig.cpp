#include "fusion-server/registration/ray_rig.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/units.h"
#include "fusion-server/registration/ray_views.h"

namespace chorus::registration {
namespace {

constexpr std::size_t kMostPairs = 40;  // of the view graph, those with most in common
constexpr std::size_t kStarts = 4;      // pairs to begin with
constexpr double kAgreement = 0.5;      // least share of rays that agree
constexpr double kLeastParallax = deg(2);
constexpr double kUnlike = 0.05;       // arrangements differ by more than noise
constexpr double kNearlyAsGood = 1.2;  // of the cost of the best
constexpr int kRough = 6;              // iterations after each camera
constexpr int kFine = 25;

/// A pair of cameras of the view graph.
struct View {
  std::size_t first = 0;
  std::size_t second = 0;
  TwoViews seen;
  /// Rays that agree, times how well they cross.
  [[nodiscard]] double worth() const {
    return static_cast<double>(seen.agreeing) * std::sin(std::min(seen.parallax, deg(90)));
  }
};

const RaySight* sight_of(const RayPoint& point, std::size_t camera) {
  const auto found = std::ranges::find(point.seen, camera, &RaySight::camera);
  return found == point.seen.end() ? nullptr : &*found;
}

CommonRays common_of(const std::vector<RayPoint>& points, std::size_t first, std::size_t second) {
  CommonRays rays;
  for (const RayPoint& point : points) {
    const RaySight* a = sight_of(point, first);
    const RaySight* b = sight_of(point, second);
    if (a == nullptr || b == nullptr) continue;
    rays.first.push_back(a->ray);
    rays.second.push_back(b->ray);
  }
  return rays;
}

/// All pairs with enough in common, those with the most first.
std::vector<std::pair<View, CommonRays>> graph_of(const std::vector<RayPoint>& points,
                                                  std::size_t cameras) {
  std::vector<std::pair<View, CommonRays>> graph;
  for (std::size_t a = 0; a < cameras; ++a) {
    for (std::size_t b = a + 1; b < cameras; ++b) {
      CommonRays rays = common_of(points, a, b);
      if (rays.first.size() >= kLeastCommon) graph.push_back({{a, b, {}}, std::move(rays)});
    }
  }
  std::ranges::stable_sort(graph, [](const auto& x, const auto& y) {
    return x.second.first.size() > y.second.first.size();
  });
  if (graph.size() > kMostPairs) graph.resize(kMostPairs);
  return graph;
}

/// The pairs to begin with, best first; an Error if there is none.
Result<std::vector<View>> starts_of(const std::vector<RayPoint>& points,
                                    const std::vector<std::string>& names) {
  const auto graph = graph_of(points, names.size());
  if (graph.empty())
    return fail(ErrorCode::NotFound, "rays",
                fmt::format("no two of the cameras that send directions alone ({}) saw the person "
                            "together for long enough: walk where two of them see you",
                            fmt::join(names, ", ")));
  std::vector<View> starts;
  double widest = 0.0;
  for (const auto& [pair, rays] : graph) {
    const auto seen = two_views(rays);
    if (!seen) continue;
    const double parallax = std::min(seen->parallax, seen->beyond_turn);
    widest = std::max(widest, parallax);
    if (parallax < kLeastParallax) continue;
    starts.push_back({pair.first, pair.second, *seen});
  }
  if (starts.empty() && widest > 0.0)
    return fail(ErrorCode::Unavailable, "rays",
                fmt::format("the cameras that send directions alone ({}) look from one place, or "
                            "are only turned: directions without depth need cameras that stand "
                            "apart",
                            fmt::join(names, ", ")));
  if (starts.empty())
    return fail(ErrorCode::Conflict, "rays",
                fmt::format("no two of the cameras that send directions alone ({}) agree about "
                            "the walk: check their lenses and clocks, and walk alone",
                            fmt::join(names, ", ")));
  std::ranges::stable_sort(starts, std::greater{}, &View::worth);
  return starts;
}

KnownPoints known_to(const std::vector<RayPoint>& points, std::size_t camera) {
  KnownPoints known;
  for (const RayPoint& point : points) {
    const RaySight* own = sight_of(point, camera);
    if (own == nullptr || !point.x) continue;
    known.points.push_back(*point.x);
    known.rays.push_back(own->ray);
  }
  return known;
}

/// The camera without a place that has the most rays to known joints.
std::optional<std::pair<std::size_t, KnownPoints>> next_of(const RayRig& rig, std::size_t cameras) {
  std::optional<std::pair<std::size_t, KnownPoints>> next;
  for (std::size_t camera = 0; camera < cameras; ++camera) {
    if (rig.places.contains(camera) || rig.refused.contains(camera)) continue;
    KnownPoints known = known_to(rig.points, camera);
    if (!next || known.points.size() > next->second.points.size())
      next = {camera, std::move(known)};
  }
  return next;
}

/// Share of the camera's rays to known joints that count.
double share_counted(const RayRig& rig, std::size_t camera) {
  double counted = 0.0;
  double all = 0.0;
  for (const RayPoint& point : rig.points) {
    const RaySight* own = sight_of(point, camera);
    if (own == nullptr || !point.x) continue;
    all += 1.0;
    counted += own->counted ? 1.0 : 0.0;
  }
  return all > 0.0 ? counted / all : 0.0;
}

/// Places the camera among the joints that are known, or says why not.
void attach(RayRig& rig, std::size_t camera, const KnownPoints& known, const std::string& name) {
  const auto found = place_among(known);
  if (!found && found.error().code == ErrorCode::NotFound) {
    rig.refused[camera] = fmt::format(
        "sensor {} saw the person together with the other cameras only briefly ({}): walk where it "
        "and two others see you",
        name, found.error().message);
    return;
  }
  const RayPlaces before = rig.places;
  if (found && found->agreeing >= kAgreement) {
    rig.places[camera] = found->points_from_camera;
    rig.misfit = adjust_rays(rig.points, rig.places, kRough);
    if (share_counted(rig, camera) >= kAgreement) return;
  }
  rig.places = before;
  rig.misfit = adjust_rays(rig.points, rig.places, 1);
  rig.refused[camera] = fmt::format(
      "sensor {} contradicts the other cameras: it followed somebody else, or its lens or its "
      "clock is wrong; walk alone",
      name);
}

RayRig grown_from(const View& start, const std::vector<RayPoint>& points,
                  const std::vector<std::string>& names) {
  RayRig rig;
  rig.points = points;
  rig.places[start.first] = Eigen::Isometry3d::Identity();
  rig.places[start.second] = start.seen.first_from_second;
  rig.misfit = adjust_rays(rig.points, rig.places, kFine);
  while (const auto next = next_of(rig, names.size()))
    attach(rig, next->first, next->second, names[next->first]);
  rig.misfit = adjust_rays(rig.points, rig.places, kFine);
  return rig;
}

/// By how much two arrangements of the same cameras differ: the greatest shift of a camera, by the
/// mean distance from the first, when both are of one size.
double unlikeness(const RayPlaces& one, const RayPlaces& other) {
  const auto from_first = [](const RayPlaces& places) {
    RayPlaces moved;
    const Eigen::Isometry3d first = places.begin()->second.inverse();
    for (const auto& [camera, place] : places) moved[camera] = first * place;
    const double size = size_of(moved) / static_cast<double>(moved.size() - 1);
    for (auto& [camera, place] : moved) place.translation() /= std::max(1e-9, size);
    return moved;
  };
  const RayPlaces a = from_first(one);
  const RayPlaces b = from_first(other);
  double most = 0.0;
  for (const auto& [camera, place] : a) {
    const auto found = b.find(camera);
    if (found == b.end()) return 1.0;
    most = std::max(most, (place.translation() - found->second.translation()).norm());
  }
  return most;
}

/// True if the first places more cameras, or as many and better.
bool is_better(const RayRig& one, const RayRig& other) {
  if (one.places.size() != other.places.size()) return one.places.size() > other.places.size();
  const double misfit = std::min(one.misfit, other.misfit);
  return rays_cost(one.points, one.places, misfit) < rays_cost(other.points, other.places, misfit);
}

/// True if another arrangement of as many cameras explains the walk nearly as well.
bool is_rivalled(const RayRig& best, const std::vector<RayRig>& all) {
  const double cost = rays_cost(best.points, best.places, best.misfit);
  return std::ranges::any_of(all, [&](const RayRig& other) {
    return other.places.size() == best.places.size() &&
           unlikeness(best.places, other.places) > kUnlike &&
           rays_cost(other.points, other.places, best.misfit) < kNearlyAsGood * cost;
  });
}

}  // namespace

Result<RayRig> rig_of(std::vector<RayPoint> points, const std::vector<std::string>& names) {
  const auto starts = starts_of(points, names);
  if (!starts) return pass(starts);
  std::vector<RayRig> rigs;
  for (std::size_t i = 0; i < std::min(kStarts, starts->size()); ++i)
    rigs.push_back(grown_from((*starts)[i], points, names));
  const auto best = std::ranges::min_element(rigs, is_better);
  if (is_rivalled(*best, rigs))
    return fail(ErrorCode::Conflict, "rays",
                fmt::format("the cameras that send directions alone ({}) can stand in two ways "
                            "that explain the walk nearly alike: walk longer, and everywhere where "
                            "they see you",
                            fmt::join(names, ", ")));
  return std::move(*best);
}

}  // namespace chorus::registration
