#include "tests/bench/methods/nearest_neighbour.h"

#include <algorithm>

#include "common/body/bones.h"

namespace chorus::bench::baselines {
namespace {

constexpr double kGate = 0.6;  // [m] the same as the product's
constexpr int kConfirm = 3;
constexpr Duration kCoast = std::chrono::seconds(1);

}  // namespace

Eigen::Vector2d place_of(const Skeleton<WorldSpace>& body) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (const JointId id : kCoreJoints) {
    if (!body[id].seen()) continue;
    sum += Eigen::Vector2d(body[id].position.x(), body[id].position.z());
    count += 1.0;
  }
  return sum / count;
}

void NearestNeighbour::assign(const std::vector<SensorView>& views) {
  struct Pair {
    double distance;
    std::size_t track;
    const SensorView* view;
  };
  std::vector<Pair> pairs;
  for (const SensorView& view : views) {
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      const double distance = (place_of(view.skeleton) - tracks_[t].place).norm();
      if (distance <= kGate) pairs.push_back({distance, t, &view});
    }
  }
  std::ranges::stable_sort(pairs, {}, &Pair::distance);
  std::vector<const SensorView*> taken;
  for (const Pair& pair : pairs) {
    auto& mine = tracks_[pair.track].views;
    const bool has_sensor = std::ranges::any_of(
        mine, [&](const SensorView* v) { return v->sensor == pair.view->sensor; });
    if (has_sensor || std::ranges::find(taken, pair.view) != taken.end()) continue;
    mine.push_back(pair.view);
    taken.push_back(pair.view);
  }
}

void NearestNeighbour::add_newcomers(const std::vector<SensorView>& views) {
  const std::size_t known = tracks_.size();
  for (const SensorView& view : views) {
    const auto has = [&](const Track& t) {
      return std::ranges::find(t.views, &view) != t.views.end();
    };
    if (std::ranges::any_of(tracks_, has) || !place_of(view.skeleton).allFinite()) continue;
    const auto joins = std::find_if(
        tracks_.begin() + static_cast<std::ptrdiff_t>(known), tracks_.end(), [&](const Track& t) {
          const bool has_sensor = std::ranges::any_of(
              t.views, [&](const SensorView* v) { return v->sensor == view.sensor; });
          return !has_sensor && (t.place - place_of(view.skeleton)).norm() <= kGate;
        });
    if (joins != tracks_.end()) {
      joins->views.push_back(&view);
    } else {
      tracks_.push_back({PersonId{next_id_++}, {}, 0, place_of(view.skeleton), {&view}});
    }
  }
}

std::vector<Person> NearestNeighbour::group(const std::vector<SensorView>& views,
                                            Timestamp instant) {
  std::erase_if(tracks_, [&](const Track& t) { return instant - t.seen > kCoast; });
  assign(views);
  add_newcomers(views);
  std::vector<Person> people;
  for (Track& track : tracks_) {
    if (track.views.empty()) continue;
    track.seen = instant;
    ++track.hits;
    track.place.setZero();
    Person person{track.id, {}};
    for (const SensorView* view : track.views) {
      track.place += place_of(view->skeleton) / static_cast<double>(track.views.size());
      person.views.push_back(*view);
    }
    track.views.clear();
    if (track.hits >= kConfirm) people.push_back(std::move(person));
  }
  return people;
}

}  // namespace chorus::bench::baselines
