#include "tests/judge/hall.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/geometry/rotation.h"
#include "common/synthetic/coloured_noise.h"
#include "common/synthetic/draw.h"
#include "fusion-server/site/places.h"

namespace chorus::bench {
namespace {

using synthetic::ColouredNoise;
using synthetic::Draw;

constexpr Timestamp kHallBegins = from_unix_ns(1'795'000'000'000'000'000);
constexpr double kBiasLasts = 3.0;    // [s]
constexpr double kNoiseStays = 0.15;  // [s]
// A cell publishes a person after three instants in view.
constexpr double kConfirmed = 0.1;
constexpr double kLearned = 0.3;  // [s] in view that double the variance of a length

/// Trunk, neck and head, shoulders, upper arm, forearm, thigh, shank of an adult [m].
constexpr std::array<double, associate::kSpans> kAdult{0.50, 0.26, 0.36, 0.29, 0.26, 0.42, 0.41};

constexpr double kLimbErrorLasts = 0.35;  // [s]
constexpr double kGait = 1.1;             // [s] for two steps

double noise_at(std::initializer_list<std::uint64_t> key, double tau, double time) {
  return ColouredNoise(Draw(key), tau).at(time);
}

/// The velocity from places a tenth of a second apart.
Eigen::Vector2d velocity_at(const HallPath& path, double time) {
  constexpr double kStep = 0.05;
  const auto before = path(time - kStep);
  const auto after = path(time + kStep);
  if (!before || !after) return Eigen::Vector2d::Zero();
  return (*after - *before) / (2.0 * kStep);
}

/// What swings about the middle of the body, and by how much of what an ankle does.
struct Swinging {
  JointId joint;
  double share;
};
constexpr std::array<Swinging, 8> kSwinging{{{JointId::AnkleLeft, 1.0},
                                             {JointId::AnkleRight, -1.0},
                                             {JointId::KneeLeft, 0.5},
                                             {JointId::KneeRight, -0.5},
                                             {JointId::WristLeft, -0.6},
                                             {JointId::WristRight, 0.6},
                                             {JointId::ElbowLeft, -0.3},
                                             {JointId::ElbowRight, 0.3}}};

}  // namespace

Skeleton<WorldSpace> standing_body(const Eigen::Vector2d& place, double yaw,
                                   const std::array<double, associate::kSpans>& build) {
  using enum JointId;
  std::array<double, associate::kSpans> length{};
  for (std::size_t i = 0; i < length.size(); ++i) length[i] = kAdult[i] * build[i];
  Skeleton<WorldSpace> body;
  const Eigen::Quaterniond turn = about_y(yaw);
  const double hip = 0.09 + length[5] + length[6];
  const auto put = [&](JointId joint, double left, double up, double front) {
    Joint& each = body[joint];
    each.position =
        Eigen::Vector3d(place.x(), 0, place.y()) + turn * Eigen::Vector3d(left, up, front);
    each.state = JointState::Tracked;
  };
  const double neck = hip + length[0];
  put(SpineBase, 0, hip, 0);
  put(SpineMid, 0, hip + 0.5 * length[0], 0);
  put(SpineShoulder, 0, neck, 0);
  put(Neck, 0, neck + 0.3 * length[1], 0);
  put(Head, 0, neck + length[1], 0);
  for (const double side : {1.0, -1.0}) {
    const bool left = side > 0;
    const double shoulder = side * 0.5 * length[2];
    const double elbow = neck - length[3];
    const double wrist = elbow - length[4];
    put(left ? ShoulderLeft : ShoulderRight, shoulder, neck, 0);
    put(left ? ElbowLeft : ElbowRight, shoulder, elbow, 0);
    put(left ? WristLeft : WristRight, shoulder, wrist, 0);
    put(left ? HandLeft : HandRight, shoulder, wrist - 0.08, 0);
    put(left ? HandTipLeft : HandTipRight, shoulder, wrist - 0.16, 0);
    put(left ? ThumbLeft : ThumbRight, shoulder, wrist - 0.08, 0.04);
    put(left ? HipLeft : HipRight, side * 0.09, hip, 0);
    put(left ? KneeLeft : KneeRight, side * 0.09, hip - length[5], 0);
    put(left ? AnkleLeft : AnkleRight, side * 0.09, 0.09, 0);
    put(left ? FootLeft : FootRight, side * 0.09, 0.03, 0.12);
  }
  return body;
}

Hall::Hall(std::vector<HallCell> cells, std::vector<HallPerson> people, std::uint64_t seed,
           HallErrors errors, HallFaults faults)
    : cells_(std::move(cells)),
      people_(std::move(people)),
      seed_(seed),
      errors_(errors),
      faults_(std::move(faults)) {
  const std::size_t count = cells_.size();
  boots_.assign(count, 1);
  sequences_.assign(count, 0);
  bodies_.assign(count, 0);
  visits_.resize(count);
  told_.resize(count);
  truth_.resize(count);
  events_.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    sites_.emplace_back(cells_[c].id, boots_[c]);
    restart(c);
  }
}

Timestamp Hall::clock(std::size_t cell) const {
  return kHallBegins + from_seconds(time_) + cells_[cell].clock_ahead;
}

void Hall::restart(std::size_t cell) {
  ++boots_[cell];
  sequences_[cell] = 0;
  bodies_[cell] = 0;
  visits_[cell].clear();
  sites_[cell] = site::Site(cells_[cell].id, boots_[cell]);
  for (const HallCell& each : cells_) (void)sites_[cell].take(each.stated, clock(cell));
  for (const auto& [id, claim] : store_) sites_[cell].take(claim, clock(cell));
}

void Hall::move_world(std::size_t cell, const Eigen::Isometry3d& new_from_old) {
  cells_[cell].site_from_cell = cells_[cell].site_from_cell * new_from_old.inverse();
  cells_[cell].stated = site::after_move(cells_[cell].stated, new_from_old);
  for (const Letter& letter : letters_)  // told in the world before
    (void)sites_[letter.to].take(letter.people, clock(letter.to));
  letters_.clear();
  for (site::Site& each : sites_) (void)each.take(cells_[cell].stated, clock(cell));
}

bool Hall::sees(std::size_t cell, const Eigen::Vector2d& place) const {
  const HallCell& looking = cells_[cell];
  return looking.sees.contains(place) &&
         std::ranges::none_of(looking.blind, [&](const auto& box) { return box.contains(place); });
}

site::Person Hall::seen(std::size_t cell, std::size_t person, const Visit& visit) const {
  const HallPath& path = people_[person].path;
  const Eigen::Vector2d truth = *path(time_);
  const Eigen::Vector2d walking = velocity_at(path, time_);
  Eigen::Vector2d place = truth;
  for (std::uint64_t axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    place[i] += errors_.bias * noise_at({seed_, 11, cell, person, axis}, kBiasLasts, time_) +
                errors_.noise * noise_at({seed_, 12, cell, person, axis}, kNoiseStays, time_);
  }
  std::array<double, associate::kSpans> build{};
  site::Person told;
  const double in_view = std::max(time_ - visit.since, 1e-3);
  const double variance = errors_.length * errors_.length * (1.0 + kLearned / in_view) + 1e-4;
  for (std::size_t i = 0; i < build.size(); ++i) {
    build[i] = people_[person].size * (1.0 + people_[person].build[i]) * std::exp(visit.off[i]);
    const double shaken = std::sqrt(kLearned / in_view) * errors_.length *
                          noise_at({seed_, 13, cell, person, i}, 1.0, visit.since);
    told.lengths.mean[i] = std::log(kAdult[i] * build[i]) + std::clamp(shaken, -0.1, 0.1);
    told.lengths.variance[i] = variance;
  }
  const double yaw = std::atan2(walking.x(), walking.y());
  const Eigen::Isometry3d cell_from_site = cells_[cell].site_from_cell.inverse();
  Skeleton<WorldSpace> body = standing_body(place, yaw, build);
  if (people_[person].swings) swing(cell, person, walking, body);
  told.body = visit.body;
  told.since = kHallBegins + from_seconds(visit.since) + cells_[cell].clock_ahead;
  for (std::size_t i = 0; i < kJointCount; ++i)
    told.joints[i] = cell_from_site * body.joints[i].position;
  told.place = *told.joints[index_of(JointId::SpineBase)];
  told.velocity = cell_from_site.linear() * Eigen::Vector3d(walking.x(), 0, walking.y());
  told.covariance = errors_.stated * errors_.stated * Eigen::Matrix3d::Identity();
  return told;
}

/// A foot that stands stays where it is for half of a gait cycle, so an ankle goes a quarter of the
/// way of a cycle to and fro.
void Hall::swing(std::size_t cell, std::size_t person, const Eigen::Vector2d& walking,
                 Skeleton<WorldSpace>& body) const {
  const double ahead = 0.25 * kGait * std::sin(2.0 * std::numbers::pi * time_ / kGait);
  for (std::size_t i = 0; i < kSwinging.size(); ++i) {
    Eigen::Vector3d& at = body[kSwinging[i].joint].position;
    at += kSwinging[i].share * ahead * Eigen::Vector3d(walking.x(), 0, walking.y());
    for (std::uint64_t axis = 0; axis < 3; ++axis)
      at[static_cast<Eigen::Index>(axis)] +=
          errors_.limb * noise_at({seed_, 15, cell, person, i, axis}, kLimbErrorLasts, time_);
  }
}

void Hall::look(std::size_t cell) {
  told_[cell] = {cells_[cell].id, boots_[cell], ++sequences_[cell], clock(cell), {}};
  truth_[cell].clear();
  for (std::size_t p = 0; p < people_.size(); ++p) {
    const auto place = people_[p].path(time_);
    if (!place || !sees(cell, *place)) {
      visits_[cell].erase(p);
      continue;
    }
    const auto [at, fresh] = visits_[cell].try_emplace(p);
    Visit& visit = at->second;
    if (fresh) {
      visit.body = PersonId{++bodies_[cell]};
      visit.since = time_ + kConfirmed;
      Draw draw({seed_, 14, cell, p, bodies_[cell]});
      for (double& off : visit.off) off = errors_.length * draw.gauss();
    }
    if (time_ < visit.since) continue;
    told_[cell].people.push_back(seen(cell, p, visit));
    truth_[cell].push_back(p);
  }
}

void Hall::send(std::size_t cell) {
  site::CellPeople letter = told_[cell];
  if (faults_.forge) faults_.forge(cell, time_, letter);
  for (std::size_t to = 0; to < cells_.size(); ++to) {
    if (to == cell || (faults_.hears && !faults_.hears(cell, to, time_))) continue;
    letters_.push_back({time_ + seconds(faults_.delay), to, letter});
  }
}

void Hall::deliver() {
  while (!letters_.empty() && letters_.front().due <= time_) {
    const Letter& letter = letters_.front();
    (void)sites_[letter.to].take(letter.people, clock(letter.to));
    letters_.pop_front();
  }
}

void Hall::serve(std::size_t cell, const site::ClaimRequest& request) {
  if (faults_.store && !faults_.store(cell, time_)) return;
  const auto at = store_.find(request.value.id);
  const std::uint64_t now = at == store_.end() ? 0 : at->second.revision;
  const bool accepted = request.expected == now;
  if (accepted) {
    site::Claim claim = request.value;
    claim.revision = now + 1;
    store_[claim.id] = claim;
    for (std::size_t each = 0; each < cells_.size(); ++each) {
      if (each != cell && (!faults_.store || faults_.store(each, time_)))
        sites_[each].take(claim, clock(each));
    }
  } else {
    ++refused_;
  }
  sites_[cell].take(site::ClaimResult{store_[request.value.id], accepted}, clock(cell));
}

void Hall::decide(std::size_t cell) {
  const site::Decision decision = sites_[cell].decide(clock(cell));
  for (std::size_t i = 0; i < told_[cell].people.size(); ++i) {
    site::Person& person = told_[cell].people[i];
    const auto named = std::ranges::find(decision.people, person.body, &site::Named::body);
    if (named == decision.people.end()) continue;
    person.site_id = named->id;
    person.site_certainty = named->certainty;
    person.named = named->since;
    words_.push_back({cell, truth_[cell][i], person.body, named->id, named->certainty,
                      named->doubtful, named->owner});
  }
  events_[cell].insert(events_[cell].end(), decision.events.begin(), decision.events.end());
  for (const site::ClaimRequest& request : decision.claims) serve(cell, request);
  for (const site::SameAs& each : decision.same_as) {
    for (std::size_t to = 0; to < cells_.size(); ++to) {
      if (to != cell && (!faults_.hears || faults_.hears(cell, to, time_)))
        sites_[to].take(each, cells_[cell].id, clock(to));
    }
  }
}

void Hall::look_only() {
  time_ += kPeriod;
  for (std::size_t c = 0; c < cells_.size(); ++c) look(c);
}

void Hall::step() {
  words_.clear();
  time_ += kPeriod;
  deliver();
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    look(c);
    (void)sites_[c].take(told_[c], clock(c));
    decide(c);
    send(c);
  }
}

}  // namespace chorus::bench
