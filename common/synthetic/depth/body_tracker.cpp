#include "common/synthetic/depth/body_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/units.h"
#include "common/body/facing.h"

namespace chorus::synthetic::depth {
namespace {

constexpr std::size_t kMostTracks = 6;    // As a Kinect v2.
constexpr std::size_t kMostPoints = 400;  // Number of a person's points that the fit uses.
// With fewer points of a body than this, the frame counts as poor for it.
constexpr std::size_t kFewPoints = 40;
constexpr std::size_t kNewPoints = 120;  // Least number of points of a new person.
constexpr int kRounds = 4;
constexpr int kFirstRounds = 15;
constexpr std::array kFirstYaws{0.0, deg(40), -deg(40), deg(80), -deg(80)};
// Reach of a body's surface: points within it may belong to the body [m].
constexpr double kReach = 0.35;
// Reach of a body's surface for a piece of which less than kOwnShare is near a body [m].
constexpr double kMixedReach = 0.12;
// If at least this share of a piece is within kMixedReach of bodies, kReach applies to all of it.
constexpr double kOwnShare = 0.5;
// If less than this share of a piece is within kMixedReach, it is a new person or an object.
constexpr double kForeignShare = 0.1;
constexpr int kConfirmed = 3;  // Frames before a body is reported.
constexpr int kPatience = 10;  // More poor frames in a row end the track.
// Largest mean distance of points to the surface of a good fit [m].
constexpr double kBadFit = 0.035;
constexpr double kTrunkSeen = 0.15;     // Least support of head and chest of a real body.
constexpr double kSame = 0.15;          // Two trunks cannot be closer than this [m].
constexpr double kExchange = deg(100);  // Beyond this facing, left and right are swapped.
constexpr double kTracked = 0.3;        // Least support of a tracked joint.
constexpr int kForgotten = 60;  // Frames without support after which a joint is not tracked.
// Up to this far outside the image, joints are inferred; farther out they are not tracked [px].
constexpr double kBorder = 6.0;
// Limits of a person's height [m].
constexpr double kLeastHeight = 1.4;
constexpr double kMostHeight = 2.05;
// In each frame the height grows by this share of what it lacks to the seen height.
constexpr double kGrowth = 0.2;
constexpr int kGrowing = 60;  // Frames in which the height is learned.
// Points this near to the head node count for the height [m].
constexpr double kHeadReach = 0.2;
constexpr double kWidest = 1.2;  // Largest width of a new person [m].
constexpr double kLowestTop =
    1.1;  // Least height of a new person's topmost point above the floor [m].
constexpr double kTallest = 0.7;  // Least vertical extent of a new person [m].
// Points less than kHeadBand below the topmost one must not spread wider than kHeadWidth [m].
constexpr double kHeadBand = 0.15;
constexpr double kHeadWidth = 0.45;
constexpr double kHalfWidth = 0.18;  // From a shoulder to the middle of a body [m].
constexpr double kHalfDepth = 0.10;  // From the surface to the middle of a body [m].

struct Extent {
  Eigen::Vector3d least = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d most = -least;

  void include(const Eigen::Vector3d& point) {
    least = least.cwiseMin(point);
    most = most.cwiseMax(point);
  }
  [[nodiscard]] double width() const {
    return std::max(most.x() - least.x(), most.z() - least.z());
  }
};

double top_of(const std::vector<SurfacePoint>& points) {
  double top = 0;
  for (const SurfacePoint& point : points) top = std::max(top, point.above_floor);
  return top;
}

/// True if the piece has the size of a person and something like a head on top.
bool may_be_person(const std::vector<SurfacePoint>& piece) {
  if (piece.size() < kNewPoints) return false;
  const double top = top_of(piece);
  double bottom = top;
  Extent whole;
  Extent head;
  for (const SurfacePoint& point : piece) {
    whole.include(point.position);
    bottom = std::min(bottom, point.above_floor);
    if (point.above_floor > top - kHeadBand) head.include(point.position);
  }
  return top > kLowestTop && top < kMostHeight + kHeadBand && top - bottom > kTallest &&
         whole.width() < kWidest && head.width() < kHeadWidth;
}

/// A person who stands where the piece is and faces the sensor, turned by `yaw`.
Stance guess(const std::vector<SurfacePoint>& piece, const Plane& floor, double yaw) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const SurfacePoint& point : piece) {
    middle += point.position / static_cast<double>(piece.size());
  }
  Stance stance;
  stance.up = floor.normal;
  const Eigen::Vector3d away =
      (middle - middle.dot(floor.normal) * floor.normal).stableNormalized();
  middle += (kHalfDepth + (kHalfWidth - kHalfDepth) * std::abs(std::sin(yaw))) * away;
  stance.foot = middle - (floor.normal.dot(middle) + floor.offset) * floor.normal;
  stance.left = Eigen::AngleAxisd(yaw, stance.up) * stance.up.cross(-away);
  stance.height = std::clamp(top_of(piece), kLeastHeight, kMostHeight);
  return stance;
}

std::vector<SurfacePoint> thinned(const std::vector<SurfacePoint>& points) {
  if (points.size() <= kMostPoints) return points;
  std::vector<SurfacePoint> some;
  for (std::size_t i = 0; i < kMostPoints; ++i) {
    some.push_back(points[i * points.size() / kMostPoints]);
  }
  return some;
}

void learn_height(FittedBody& body, const std::vector<SurfacePoint>& points) {
  double top = 0;
  for (const SurfacePoint& point : points) {
    if ((point.position - body.now.col(kHead)).norm() < kHeadReach) {
      top = std::max(top, point.above_floor);
    }
  }
  if (top > body.height) body.height += kGrowth * (std::min(top, kMostHeight) - body.height);
}

/// If the body seems to face away from the sensor, swaps left and right, so that it faces the
/// sensor.
void believe_it_faces_us(FittedBody& body) {
  const auto facing = facing_angle(joints_of(body.now, body.height));
  if (!facing || std::abs(*facing) <= kExchange) return;
  body.now = exchanged(body.now);
  body.before = exchanged(body.before);
  const auto support = body.support;
  for (std::size_t i = 0; i < kNodeCount; ++i) {
    body.support[i] = support[other_side(static_cast<Node>(i))];
  }
}

}  // namespace

Evidence BodyTracker::evidence_of(const Track& track, const DepthImage& image,
                                  const Plane& floor) const {
  Evidence evidence;
  evidence.points = track.points;
  evidence.image = &image;
  evidence.camera = &camera_;
  evidence.up = floor.normal;
  return evidence;
}

void BodyTracker::share_out(const Foreground& foreground, std::vector<bool>& unexplained) {
  struct Claim {
    std::size_t track = 0;
    double distance = std::numeric_limits<double>::infinity();
  };
  std::vector<Claim> claims(foreground.points.size());
  std::vector<std::size_t> size(foreground.pieces, 0);
  std::vector<std::size_t> near(foreground.pieces, 0);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const SurfacePoint& point = foreground.points[i];
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      const double distance =
          distance_to(tracks_[t].body.now, tracks_[t].body.height, point.position);
      if (distance < claims[i].distance) claims[i] = {t, distance};
    }
    ++size[point.piece];
    if (claims[i].distance < kMixedReach) ++near[point.piece];
  }
  std::vector<double> reach(foreground.pieces, kMixedReach);
  for (std::size_t piece = 0; piece < foreground.pieces; ++piece) {
    const double share = static_cast<double>(near[piece]) / static_cast<double>(size[piece]);
    if (share >= kOwnShare) reach[piece] = kReach;
    unexplained[piece] = share < kForeignShare;
  }
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const SurfacePoint& point = foreground.points[i];
    if (claims[i].distance < reach[point.piece]) tracks_[claims[i].track].points.push_back(point);
  }
}

void BodyTracker::follow(Track& track, const DepthImage& image, const Plane& floor) {
  ++track.age;
  const std::size_t all = track.points.size();
  if (track.age < kGrowing) learn_height(track.body, track.points);
  track.points = thinned(track.points);
  Evidence evidence = evidence_of(track, image, floor);
  if (all > 0) evidence.share = static_cast<double>(track.points.size()) / static_cast<double>(all);
  fit(track.body, evidence, track.age == 1 ? kFirstRounds : kRounds);
  believe_it_faces_us(track.body);
  const double trunk = std::min(track.body.support[kHead], track.body.support[kChest]);
  const bool is_poor = all < kFewPoints || track.body.misfit > kBadFit || trunk < kTrunkSeen;
  track.poor = is_poor ? track.poor + 1 : 0;
  for (std::size_t i = 0; i < kNodeCount; ++i) {
    track.unseen[i] = track.body.support[i] < kTracked ? track.unseen[i] + 1 : 0;
  }
}

void BodyTracker::give_up() {
  std::erase_if(tracks_, [](const Track& track) {
    return track.poor > kPatience || !track.body.now.allFinite();
  });
  // Of two bodies in one place the older one is kept.
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const Eigen::Vector3d chest = tracks_[i].body.now.col(kChest);
    const auto is_double = [&chest](const Track& other) {
      return (other.body.now.col(kChest) - chest).norm() < kSame;
    };
    tracks_.erase(std::remove_if(tracks_.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                                 tracks_.end(), is_double),
                  tracks_.end());
  }
}

void BodyTracker::welcome(const std::vector<SurfacePoint>& piece, const DepthImage& image,
                          const Plane& floor) {
  if (tracks_.size() >= kMostTracks || !may_be_person(piece)) return;
  Track track;
  track.body.misfit = std::numeric_limits<double>::infinity();
  for (const double yaw : kFirstYaws) {
    Track other;
    const Stance stance = guess(piece, floor, yaw);
    other.body.height = stance.height;
    other.body.now = standing(stance);
    other.body.before = other.body.now;
    other.points = piece;
    follow(other, image, floor);
    if (other.body.misfit < track.body.misfit) track = std::move(other);
  }
  if (track.body.misfit > kBadFit) return;
  track.body.before = track.body.now;
  track.id = BodyId{next_id_++};
  tracks_.push_back(std::move(track));
}

TrackedBody BodyTracker::report(const Track& track) const {
  TrackedBody out{track.id, joints_of(track.body.now, track.body.height)};
  for (std::size_t i = 0; i < kJointCount; ++i) {
    Joint& joint = out.skeleton.joints[i];
    const Node node = node_of(static_cast<JointId>(i));
    const Eigen::Vector3d& p = joint.position;
    const double column = camera_.cx - camera_.focal * p.x() / std::max(p.z(), 0.1);
    const double row = camera_.cy - camera_.focal * p.y() / std::max(p.z(), 0.1);
    const double outside = std::max({-column, -row, column - camera_.width, row - camera_.height});
    if (outside > kBorder || track.unseen[node] > kForgotten) {
      joint = Joint{};
    } else if (outside > 0 || track.body.support[node] < kTracked) {
      joint.state = JointState::Inferred;
    }
  }
  return out;
}

std::vector<TrackedBody> BodyTracker::look(const DepthImage& image, const Plane& floor) {
  const Foreground foreground = foreground_of(image, camera_, floor);
  for (Track& track : tracks_) {
    predict(track.body);
    track.points.clear();
  }
  std::vector<bool> unexplained(foreground.pieces, false);
  share_out(foreground, unexplained);
  for (Track& track : tracks_) follow(track, image, floor);
  give_up();
  std::vector<std::vector<SurfacePoint>> pieces(foreground.pieces);
  for (const SurfacePoint& point : foreground.points) {
    if (unexplained[point.piece]) pieces[point.piece].push_back(point);
  }
  for (const auto& piece : pieces) welcome(piece, image, floor);
  std::vector<TrackedBody> bodies;
  for (const Track& track : tracks_) {
    if (track.age >= kConfirmed && track.poor == 0) bodies.push_back(report(track));
  }
  return bodies;
}

}  // namespace chorus::synthetic::depth
