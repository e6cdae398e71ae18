#include "fusion-server/associate/mirrors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/body/bones.h"

namespace chorus::associate {
namespace {

constexpr std::size_t kLeastPairs = 10;
constexpr double kApart = 0.3;  // [m]; closer bodies are two detections of one person
// [m, rms]; what depth cameras err by at a joint twice, and two people in one posture do not keep.
constexpr double kLike = 0.1;
// [m, rms] of the joints of a person and their image from a plane that is known.
constexpr double kInMirror = 0.15;
constexpr double kOnPlane = 0.15;  // [m] between the core and the reflected core, in one plane
constexpr double kStep = 0.05;     // [m]; a shorter way may be noise
constexpr double kWay = 0.5;       // [m] that a person goes while the image follows
constexpr double kUnlike = 1.0;    // [s] of another posture or place, after which it is no image
constexpr std::size_t kMostMirrors = 8;  // the oldest is forgotten then
constexpr double kLearn = 0.05;          // Share of the newest instant in a known plane.

const PlacedView* view_by(const std::vector<PlacedView>& sights, const SensorId& sensor) {
  const auto at = std::ranges::find_if(
      sights, [&](const PlacedView& sight) { return !sight.rays && sight.view.sensor == sensor; });
  return at == sights.end() ? nullptr : &*at;
}

double height_above(const Mirror& mirror, const Eigen::Vector3d& place) {
  return mirror.normal.dot(place) - mirror.offset;
}

/// True if all sensors that see the image are on the person's side of the plane, so that they may
/// look into a mirror there.
bool look_into(const Mirror& mirror, const Candidate& image, const Candidate& person,
               const std::vector<Observer>& observers) {
  const double side = height_above(mirror, person.track.core);
  return std::ranges::all_of(image.sights, [&](const PlacedView& sight) {
    const auto own = std::ranges::find(observers, sight.view.sensor, &Observer::sensor);
    return own != observers.end() &&
           height_above(mirror, own->world_from_sensor.translation()) * side > 0.0;
  });
}

/// The joints of both bodies, from the sensors that see both.
JointPairs pairs_of(const Candidate& person, const Candidate& image, Sides sides) {
  JointPairs pairs;
  for (const PlacedView& sight : image.sights) {
    const PlacedView* other = view_by(person.sights, sight.view.sensor);
    if (other && !sight.rays) pairs.add(other->view.skeleton, sight.view.skeleton, sides);
  }
  return pairs;
}

struct Likeness {
  const Candidate* person = nullptr;
  Reflection reflection = {};
  Mirror* known = nullptr;  ///< The known mirror whose plane it is; none: a new one.
};

/// The known mirror in which the pairs are a person and their image.
Mirror* mirror_of(const JointPairs& pairs, Mirrors& mirrors) {
  const auto known = std::ranges::find_if(
      mirrors, [&](const Mirror& each) { return pairs.distance(each) < kInMirror; });
  return known == mirrors.end() ? nullptr : &*known;
}

/// Moves a known mirror a little to where the instant shows it.
void refine(Mirror& mirror, const Mirror& shown) {
  const double side = mirror.normal.dot(shown.normal) < 0.0 ? -1.0 : 1.0;
  mirror.normal = ((1.0 - kLearn) * mirror.normal + kLearn * side * shown.normal).normalized();
  mirror.offset = (1.0 - kLearn) * mirror.offset + kLearn * side * shown.offset;
}

/// How the candidate is the image of `person` at this instant, if it is.
std::optional<Likeness> likeness_to(const Candidate& person, const Candidate& image,
                                    const std::vector<Observer>& observers, Mirrors& mirrors) {
  std::optional<Likeness> best;
  for (const Sides sides : {Sides::Exchanged, Sides::Kept}) {
    const JointPairs pairs = pairs_of(person, image, sides);
    const auto found = pairs.reflection();
    if (!found || (best && found->rms >= best->reflection.rms)) continue;
    if (!look_into(found->mirror, image, person, observers)) continue;
    Mirror* known = mirror_of(pairs, mirrors);
    if (found->rms < kLike || known) best = Likeness{&person, *found, known};
  }
  return best;
}

/// Whose image the candidate is at this instant, if anybody's.
std::optional<Likeness> likeness_of(const Candidate& image, const std::vector<Candidate>& all,
                                    const std::vector<Observer>& observers, Mirrors& mirrors) {
  std::optional<Likeness> best;
  for (const Candidate& person : all) {
    if (&person == &image || person.track.image.sure) continue;
    const auto found = likeness_to(person, image, observers, mirrors);
    if (found && (!best || found->reflection.rms < best->reflection.rms)) best = found;
  }
  return best;
}

/// Follows the person of whom the track is the image as it seems, in one plane.
void follow_image(Image& image, const Eigen::Vector3d& core, const Likeness& like) {
  const Eigen::Vector3d& place = like.person->track.core;
  const bool same = image.of == like.person->track.id &&
                    (reflected(image.mirror, place) - core).norm() < kOnPlane;
  if (!same) image = {like.person->track.id, like.reflection.mirror, place, 0.0, {}, true, false};
  const double step = (place - image.from).norm();
  if (step > kStep) {
    image.way += step;
    image.from = place;
    refine(image.mirror, like.reflection.mirror);
  }
  image.like = true;
  image.unlike = 0.0;
}

/// False while the person of whom the track is the image is only unseen by those who see the image.
bool comparable(const Candidate& image, const std::vector<Candidate>& all) {
  const auto person = std::ranges::find_if(
      all, [&](const Candidate& each) { return each.track.id == image.track.image.of; });
  return person == all.end() || std::ranges::any_of(image.sights, [&](const PlacedView& sight) {
           return view_by(person->sights, sight.view.sensor) != nullptr;
         });
}

}  // namespace

Eigen::Vector3d reflected(const Mirror& mirror, const Eigen::Vector3d& place) {
  return place - 2.0 * height_above(mirror, place) * mirror.normal;
}

void JointPairs::add(const Skeleton<WorldSpace>& person, const Skeleton<WorldSpace>& image,
                     Sides sides) {
  for (std::size_t i = 0; i < kJointCount; ++i) {
    const Joint& there = image.joints[i];
    const JointId id = static_cast<JointId>(i);
    const Joint& here = person[sides == Sides::Exchanged ? mirror(id) : id];
    if (there.seen() && here.seen()) pairs_.push_back({here.position, there.position});
  }
}

std::optional<Reflection> JointPairs::reflection() const {
  if (pairs_.size() < kLeastPairs) return std::nullopt;
  Eigen::Vector3d way = Eigen::Vector3d::Zero(), middle = Eigen::Vector3d::Zero();
  for (const Pair& pair : pairs_) {
    way += pair.image - pair.person;
    middle += 0.5 * (pair.image + pair.person);
  }
  const double count = static_cast<double>(pairs_.size());
  if (!(way.norm() > kApart * count)) return std::nullopt;
  const Eigen::Vector3d normal = way.normalized();
  const Mirror mirror{normal, normal.dot(middle / count)};
  return Reflection{mirror, distance(mirror)};
}

double JointPairs::distance(const Mirror& mirror) const {
  if (pairs_.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const Pair& pair : pairs_)
    sum += (pair.image - reflected(mirror, pair.person)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(pairs_.size()));
}

void reflect(std::vector<Candidate>& candidates, const std::vector<Observer>& observers,
             double elapsed, Mirrors& mirrors) {
  for (Candidate& candidate : candidates) {
    if (candidate.sights.empty()) continue;
    Image& image = candidate.track.image;
    const auto like = likeness_of(candidate, candidates, observers, mirrors);
    image.like = false;
    if (like && like->known && like->reflection.rms < kLike)
      refine(*like->known, like->reflection.mirror);
    if (like) {
      follow_image(image, candidate.track.core, *like);
    } else {
      if (comparable(candidate, candidates)) image.unlike += elapsed;
      if (image.unlike > kUnlike) image = {};
    }
    if (!like || image.sure) continue;
    image.sure = like->known != nullptr || image.way > kWay;
    if (!image.sure || like->known) continue;
    if (mirrors.size() >= kMostMirrors) mirrors.erase(mirrors.begin());
    mirrors.push_back(image.mirror);
  }
}

}  // namespace chorus::associate
