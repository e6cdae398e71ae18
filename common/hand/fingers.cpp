#include "common/hand/fingers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "common/hand/outline.h"
#include "common/hand/ring.h"
#include "common/hand/webs.h"

namespace chorus::hand {
namespace {

// Everything below is in radii of the palm's circle (about 40 mm), so that no scale is needed.
constexpr std::array kDepths{0.8, 0.6, 0.45, 0.32, 0.22};  // of webs, tried from deep to shallow
constexpr double kShortest = 0.75;  // Fingers from web to tip are 1.2 to 2.4; toes 0.3 to 0.6.
constexpr double kShortestOuter = 0.55;
constexpr double kLongest = 3.6;
constexpr double kWidest = 1.1;
constexpr double kSlimmest = 1.25;  // length over width
constexpr double kFullest = 0.65;   // area over squared length, of thumb and little finger
// Mean width of an outer finger: at most 0.6 in 79 pictures of people's hands.  A forearm that is
// taken for a thumb which is hidden has 1.4 and more.
constexpr double kBroadest = 0.95;
// Width of a finger half-way: 0.26 to 0.78 in those pictures.  Less where shadows or rings tear the
// outline.
constexpr double kThinnest = 0.2;
constexpr double kDeepWeb = 0.6;
constexpr double kLowestWeb = -0.55;  // below the palm's middle, along the middle finger
// A web is known if less than this share of the way from knuckles to tips is closed.
constexpr double kClosedWeb = 0.62;
constexpr std::size_t kWebsOfOneHand = 6;  // four, and one on each side of the wrist

using Four = std::array<Defect, 4>;

struct Ends {
  std::array<std::size_t, 5> tips{};
  std::array<std::size_t, 6> bases{};  ///< Around the five fingers; 1 to 4 are the webs.
};

/// What speaks against a row; later ones say more about the hand.
enum class Flaw { None, Wide, Short, Forearm, Cut };

/// The area that the outline encloses from `from` to `to` [px^2].
double area_between(const Outline& outline, std::size_t from, std::size_t to) {
  const std::size_t n = outline.points.size();
  double twice = 0.0;
  for (std::size_t i = from; i != to; i = (i + 1) % n) {
    const Pixel a = outline.points[i] - outline.points[from];
    const Pixel b = outline.points[(i + 1) % n] - outline.points[from];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(0.5 * twice);
}

struct Part {
  std::size_t from = 0;
  std::size_t tip = 0;
  std::size_t to = 0;
};

Flaw flaw_of(const Outline& outline, const Part& part, bool outer) {
  const double radius = outline.palm_radius;
  const Pixel& end = outline.points[part.tip];
  const Pixel root = 0.5 * (outline.points[part.from] + outline.points[part.to]);
  const double length = (end - root).norm() / radius;
  const double width = (outline.points[part.from] - outline.points[part.to]).norm() / radius;
  if (length < (outer ? kShortestOuter : kShortest)) return Flaw::Short;
  if (length > kLongest) return Flaw::Wide;
  if (!outer && (width > kWidest || length < kSlimmest * width)) return Flaw::Wide;
  if (outer) {
    const double area = area_between(outline, part.from, part.to) / (radius * radius);
    if (area > kFullest * length * length) return Flaw::Wide;
    if (area > kBroadest * length) return Flaw::Forearm;
  }
  return on_border(outline, end) ? Flaw::Cut : Flaw::None;
}

/// The tip of the finger before (step -1) or after (+1) a row of webs, and the other end of its
/// base.
void add_outer(const Outline& outline, const Defect& web, int step, Ends& ends) {
  const std::size_t n = outline.points.size();
  const std::size_t hull_end = step < 0 ? web.start : web.end;
  const std::size_t way =
      step < 0 ? steps(outline, hull_end, web.far) : steps(outline, web.far, hull_end);
  const std::size_t reach = std::min(n / 3, way + way / 3);
  const std::size_t last = step < 0 ? (web.far + n - reach) % n : (web.far + reach) % n;
  const Pixel& base = outline.points[web.far];
  // The hull may begin past the tip; the farthest point is a tip only if the way is short.
  const auto far = [&](const Pixel& p) { return (p - base).norm(); };
  std::size_t tip = step < 0 ? best_between(outline, last, web.far, far)
                             : best_between(outline, web.far, last, far);
  if (tip == last) tip = hull_end;
  const double length = (outline.points[tip] - base).norm();
  ends.tips[step < 0 ? 0 : 4] = tip;
  ends.bases[step < 0 ? 0 : 5] = opposite_base(outline, tip, length, step);
}

Ends ends_of(const Outline& outline, const Four& webs) {
  Ends ends;
  for (std::size_t i = 0; i < 4; ++i) ends.bases[i + 1] = webs[i].far;
  for (std::size_t i = 1; i < 4; ++i) {
    const Pixel root = 0.5 * (outline.points[ends.bases[i]] + outline.points[ends.bases[i + 1]]);
    ends.tips[i] = best_between(outline, ends.bases[i], ends.bases[i + 1],
                                [&](const Pixel& p) { return (p - root).norm(); });
  }
  add_outer(outline, webs.front(), -1, ends);
  add_outer(outline, webs.back(), +1, ends);
  return ends;
}

/// The index finger's web towards the thumb lies far below its other one: there its base is as far
/// from its tip as the other web.  `thumb_first`: the thumb is finger 0 of the row.
std::array<Part, 5> parts_between(const Outline& outline, const Ends& ends, bool thumb_first) {
  std::array<Part, 5> out;
  for (std::size_t i = 0; i < 5; ++i) out[i] = {ends.bases[i], ends.tips[i], ends.bases[i + 1]};
  Part& index = out[thumb_first ? 1 : 3];
  const std::size_t web = thumb_first ? index.to : index.from;
  const double length = (outline.points[index.tip] - outline.points[web]).norm();
  const std::size_t other = opposite_base(outline, index.tip, length, thumb_first ? -1 : +1);
  // Not beyond the thumb's web.
  if (thumb_first && steps(outline, other, index.tip) < steps(outline, index.from, index.tip))
    index.from = other;
  if (!thumb_first && steps(outline, index.tip, other) < steps(outline, index.tip, index.to))
    index.to = other;
  return out;
}

/// How far both outer webs lie along the middle finger: (first, last) in radii.
std::array<double, 2> heights(const Outline& outline, const Four& webs) {
  const auto place = [&](std::size_t i) { return outline.points[webs[i].far]; };
  const Pixel up = (0.5 * (place(1) + place(2)) - outline.palm).normalized();
  return {(place(0) - outline.palm).dot(up) / outline.palm_radius,
          (place(3) - outline.palm).dot(up) / outline.palm_radius};
}

struct Search {
  std::optional<Four> best;
  double score = 0.0;
  Flaw flaw = Flaw::None;  ///< Of the row that came nearest.
  std::size_t webs = 0;
};

Flaw worst_of(const Outline& outline, const Four& row) {
  const auto [first, last] = heights(outline, row);
  if (std::min(first, last) < kLowestWeb) return Flaw::Wide;  // a wrist's side, not the thumb's web
  const auto parts = parts_between(outline, ends_of(outline, row), first < last);
  Flaw worst = Flaw::None;
  for (std::size_t i = 0; i < 5; ++i)
    worst = std::max(worst, flaw_of(outline, parts[i], i == 0 || i == 4));
  return worst;
}

void try_rows(const Outline& outline, const std::vector<Defect>& webs, Search& search) {
  const std::size_t n = webs.size();
  for (std::size_t first = 0; n >= 4 && first < n; ++first) {
    Four row;
    for (std::size_t i = 0; i < 4; ++i) row[i] = webs[(first + i) % n];
    const Flaw flaw = worst_of(outline, row);
    double depth = 0.0;
    for (const Defect& web : row) depth += web.depth;
    // The fingers' side of the outline is the shorter one of the row.
    const double around = static_cast<double>(steps(outline, row[0].far, row[3].far)) /
                          static_cast<double>(outline.points.size());
    const double score = depth / outline.palm_radius - 2.0 * around;
    if (flaw != Flaw::None) {
      search.flaw = std::max(search.flaw, flaw);
    } else if (!search.best || score > search.score) {
      search.best = row;
      search.score = score;
    }
  }
}

Error reason(const Search& search) {
  const auto say = [](ErrorCode code, std::string text) {
    return Error{code, "hand", std::move(text)};
  };
  if (search.flaw == Flaw::Cut)
    return say(ErrorCode::InvalidArgument, "a finger is cut by the frame; show the whole hand");
  if (search.flaw == Flaw::Forearm)
    return say(ErrorCode::InvalidArgument,
               "the thumb does not stand apart; spread it, and all fingers a little");
  if (search.webs >= 4)
    return say(ErrorCode::NotFound,
               search.flaw == Flaw::Short
                   ? "the fingers are too short for a hand: is it a foot, or a fist?"
                   : "this has no hand's proportions");
  if (search.webs == 3)
    return say(ErrorCode::InvalidArgument,
               "only four fingers stand apart; spread the thumb, and all fingers a little");
  return say(ErrorCode::NotFound,
             "no five fingers stand apart: spread the fingers, or is there no hand?");
}

Split split_from(const Outline& outline, const Ends& ends, bool thumb_first) {
  Split out;
  out.thumb_first = thumb_first;
  const auto parts = parts_between(outline, ends, thumb_first);
  for (std::size_t i = 0; i < 5; ++i) {
    const Part& part = parts[i];
    FingerShape& finger = out.fingers[thumb_first ? i : 4 - i];
    finger.tip = outline.points[part.tip];
    finger.base = {outline.points[part.from], outline.points[part.to]};
    if (!thumb_first) std::swap(finger.base[0], finger.base[1]);
  }
  return out;
}

tl::unexpected<Error> cut(std::size_t finger) {
  return fail(ErrorCode::InvalidArgument, "hand",
              fmt::format("the {} is cut by the frame; show the whole hand", kFingerNames[finger]));
}

/// Refuses fingers whose middle line leaves the picture.
Result<Split> uncut(Split split, const Outline& outline) {
  for (std::size_t f = 0; f < kFingers; ++f)
    if (on_border(outline, split.fingers[f].tip)) return cut(f);
  return split;
}

/// Refuses fingers half-way along which there is no finger.
Result<Split> whole(Split split, const Outline& outline) {
  for (std::size_t f = 0; f < kFingers; ++f) {
    const FingerShape& finger = split.fingers[f];
    if (finger.touching || finger.width >= kThinnest * outline.palm_radius) continue;
    return fail(ErrorCode::InvalidArgument, "hand",
                fmt::format("the outline of the {} is torn: shadows or stripes between hand and "
                            "ground? Use even light",
                            kFingerNames[f]));
  }
  return uncut(std::move(split), outline);
}

/// Where the finger leaves the outline, along its last bone; none if the bone lies outside.
std::optional<Pixel> tip_along(const cv::Mat& fill, const SeenHand& seen, std::size_t finger) {
  const Pixel& dip = seen.joints[hand_joint(finger, 2)];
  const Pixel& tip = seen.joints[hand_joint(finger, 3)];
  const double length = (tip - dip).norm();
  if (length < 1.0) return std::nullopt;
  const Pixel along = (tip - dip) / length;
  for (const double share : {0.6, 0.3, 0.0, -0.4}) {
    const Pixel from = dip + share * length * along;
    const double out = distance_inside(fill, from, along);
    if (out > 0.0 && share * length + out < 2.6 * length) return from + out * along;
  }
  return std::nullopt;
}

/// The direction across the line through both points, to the side of `at`.
Pixel towards(const Pixel& at, const Pixel& from, const Pixel& to) {
  const Pixel across = Pixel(from.y() - to.y(), to.x() - from.x()).stableNormalized();
  return across.dot(at - from) < 0.0 ? Pixel(-across) : across;
}

tl::unexpected<Error> disagree() {
  return fail(ErrorCode::NotFound, "hand",
              "the outline does not show the fingers that the network sees");
}

/// Indices on the outline.
Result<std::array<std::size_t, 5>> tips_along(const Outline& outline, const cv::Mat& fill,
                                              const SeenHand& seen) {
  std::array<std::size_t, 5> tips{};
  for (std::size_t f = 0; f < kFingers; ++f) {
    const auto tip = tip_along(fill, seen, f);
    if (!tip) return disagree();
    tips[f] = nearest_index(outline, *tip);
    if (on_border(outline, *tip)) return cut(f);
  }
  return tips;
}

}  // namespace

Result<Split> split_by_outline(const Outline& outline, const cv::Mat& fill) {
  const auto all = defects_of(outline);
  Search search;
  std::size_t deep = 0;
  for (const Defect& each : all) {
    if (each.depth > kDeepWeb * outline.palm_radius) ++deep;
  }
  if (deep > kWebsOfOneHand)
    return fail(ErrorCode::Conflict, "hand",
                "more than five fingers stand apart: two hands? Scan one at a time");
  for (const double depth : kDepths) {
    std::vector<Defect> webs;
    std::ranges::copy_if(all, std::back_inserter(webs), [&](const Defect& each) {
      return each.depth > depth * outline.palm_radius;
    });
    search.webs = webs.size();
    try_rows(outline, webs, search);
    if (search.best) break;
  }
  if (!search.best) return tl::unexpected<Error>(reason(search));
  const auto [first, last] = heights(outline, *search.best);
  Split out = split_from(outline, ends_of(outline, *search.best), first < last);
  refine(out.fingers, fill);
  return whole(std::move(out), outline);
}

Result<Split> split_by_joints(const Outline& outline, const cv::Mat& fill, const SeenHand& seen) {
  const auto tips = tips_along(outline, fill, seen);
  if (!tips) return pass(tips);
  std::size_t around = 0, back = 0;
  for (std::size_t f = 0; f < 4; ++f) {
    around += steps(outline, (*tips)[f], (*tips)[f + 1]);
    back += steps(outline, (*tips)[f + 1], (*tips)[f]);
  }
  if (std::min(around, back) >= outline.points.size()) return disagree();
  const bool forward = around < back;
  Ends ends;
  std::array<bool, 6> closed{};  // the webs, numbered as the bases
  for (std::size_t i = 0; i < 5; ++i) ends.tips[i] = (*tips)[forward ? i : 4 - i];
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t f = forward ? i : 3 - i;  // The web lies between fingers f and f + 1.
    const Pixel knuckles =
        0.5 * (seen.joints[hand_joint(f, f == 0 ? 1 : 0)] + seen.joints[hand_joint(f + 1, 0)]);
    const Pixel& from = outline.points[ends.tips[i]];
    const Pixel& to = outline.points[ends.tips[i + 1]];
    const Pixel down = towards(knuckles, from, to);
    ends.bases[i + 1] = best_between(outline, ends.tips[i], ends.tips[i + 1], [&](const Pixel& p) {
      return f == 0 ? (p - from).dot(down) : -(p - knuckles).norm();
    });
    const double reach = (0.5 * (from + to) - knuckles).norm();
    closed[i + 1] = (outline.points[ends.bases[i + 1]] - knuckles).norm() > kClosedWeb * reach;
  }
  const auto outer = [&](std::size_t finger, std::size_t web, int step) {
    const double length =
        (outline.points[ends.tips[finger]] - outline.points[ends.bases[web]]).norm();
    return opposite_base(outline, ends.tips[finger], length, step);
  };
  ends.bases[0] = outer(0, 1, -1);
  ends.bases[5] = outer(4, 4, +1);
  Split out = split_from(outline, ends, forward);
  for (std::size_t i = 0; i < 5; ++i)
    out.fingers[forward ? i : 4 - i].touching = closed[i] || closed[i + 1];
  refine(out.fingers, fill);
  return uncut(std::move(out), outline);
}

Pixel centred(const cv::Mat& fill, const Pixel& at, const Pixel& direction, double widest) {
  const Pixel across(-direction.y(), direction.x());
  const double one = distance_inside(fill, at, across), other = distance_inside(fill, at, -across);
  if (one + other > widest || one == 0.0) return at;
  return at + 0.5 * (one - other) * across;
}

void refine(Fingers& fingers, const cv::Mat& fill) {
  constexpr std::array kAlong{0.5, 0.57, 0.64, 0.71, 0.78};  // of the way from root to tip
  for (FingerShape& finger : fingers) {
    const double length = finger.length();
    if (length < 4.0) continue;
    const Pixel along = (finger.tip - finger.root()) / length;
    const Pixel across(-along.y(), along.x());
    const double widest = 0.6 * length;
    const Pixel half = finger.root() + 0.5 * length * along;
    finger.width = distance_inside(fill, half, across) + distance_inside(fill, half, -across);
    if (finger.touching || finger.width > widest) continue;
    std::vector<Pixel> middles;
    for (const double share : kAlong)
      middles.push_back(centred(fill, finger.root() + share * length * along, along, widest));
    const Pixel direction =
        (0.5 * (middles[3] + middles[4]) - 0.5 * (middles[0] + middles[1])).normalized();
    if (direction.dot(along) < 0.8) continue;
    const Pixel from = middles[4];
    finger.tip = from + distance_inside(fill, from, direction) * direction;
  }
}

}  // namespace chorus::hand
