#include "tests/bench/accuracy/persons_cases.h"

#include <algorithm>
#include <iterator>

#include "tests/bench/accuracy/false_bodies.h"
#include "tests/bench/methods/moments.h"
#include "tests/bench/methods/nearest_neighbour.h"
#include "tests/judge/crowd.h"
#include "tests/judge/labelled_error.h"

namespace chorus::bench {
namespace {

constexpr Duration kStart = std::chrono::milliseconds(500);
constexpr Duration kTail = std::chrono::milliseconds(200);
constexpr double kClose = 0.3;  // [m] between necks: shoulder to shoulder
constexpr const char* kBestSensor = "best-sensor-ids";

using People = std::vector<synthetic::Person>;

People crossing_two(std::uint64_t seed) { return crossing_people(2, seed); }
People crossing_close(std::uint64_t seed) { return crossing_people(2, seed, kClose); }
People crossing_four(std::uint64_t seed) { return crossing_people(4, seed); }
People crossing_six(std::uint64_t seed) { return crossing_people(6, seed); }
People four_at_work(std::uint64_t seed) { return people_at_work(4, seed); }
People around_car(std::uint64_t seed) { return people_around(1.5, seed); }
People relayed(std::uint64_t seed) { return relayed_people(seed, begin_of(seed)); }
People returning(std::uint64_t seed) { return returning_people(seed, begin_of(seed)); }
People in_booth(std::uint64_t seed) { return booth_people(seed, begin_of(seed)); }

std::vector<Eigen::Isometry3d> ring(std::size_t count, double radius = 3.0) {
  synthetic::Ring ring;
  ring.count = count;
  ring.radius = radius;
  return ring_places(ring);
}

/// What the sensors see at one instant, before it is assigned to people.
using Sights = associate::Scene;

/// A method of association: returns the people at each instant, and may remember anything from one
/// instant to the next.
using Grouper = std::function<std::vector<Person>(const Sights& sights)>;

/// Makes the sensors report every occluded joint as inferred.  With profile A alone, they would
/// report many of them as tracked, close to their true positions, and thus see through the screen.
void know_the_occluded(synthetic::kinect::Profile& profile, std::size_t) {
  profile.visibility.inferred_occluded = 1.0;
}

PersonsCase behind_screen(std::string name, People (*people)(std::uint64_t seed)) {
  PersonsCase hidden{std::move(name), "A", places_behind_screen(), people, {screen()}};
  hidden.adjust = know_the_occluded;
  return hidden;
}

/// One sensor mistakes furniture for people, often and for long.
PersonsCase beside_furniture() {
  PersonsCase each{"furniture-2-B", "B", ring(6), crossing_two};
  each.adjust = [](synthetic::kinect::Profile& profile, std::size_t place) {
    if (place > 0) return;
    profile.gross.ghosts_per_minute = 6.0;
    profile.gross.ghost_time = 4.0;  // [s]
  };
  return each;
}

/// Every sensor does.
PersonsCase before_furniture(std::string name, std::vector<Eigen::Isometry3d> places) {
  PersonsCase each{std::move(name), "B", std::move(places), crossing_two};
  each.adjust = [](synthetic::kinect::Profile& profile, std::size_t) {
    profile.gross.ghosts_per_minute = 6.0;
    profile.gross.ghost_time = 4.0;  // [s]
  };
  return each;
}

PersonsCase deceived(std::string name, void (*distort)(Workshop& workshop)) {
  PersonsCase each{std::move(name), "A", ring(6), crossing_two};
  each.distort = distort;
  each.length = std::chrono::seconds(10);  // what is false is so from the first instant on
  return each;
}

PersonsCase at_work_side_by_side(std::string name, std::size_t sensors) {
  PersonsCase each{std::move(name), "A", ring(sensors), side_by_side};
  each.sides = true;
  return each;
}

Setting setting_of(const PersonsCase& each, std::uint64_t seed) {
  Setting setting;
  setting.profile = each.profile;
  setting.seed = seed;
  setting.places = each.places;
  setting.people = each.people(seed);
  setting.occluders = each.occluders;
  setting.length = each.length;
  setting.adjust = each.adjust;
  return setting;
}

Workshop workshop_of(const PersonsCase& each, std::uint64_t seed) {
  Workshop workshop = draw_workshop(setting_of(each, seed));
  if (each.distort) each.distort(workshop);
  return workshop;
}

/// True horizontal place of a person; NaN while the person is out of the room.
Eigen::Vector2d true_place(const Workshop& workshop, std::size_t person, Timestamp instant,
                           const SensorId& master) {
  const Eigen::Vector2d place = baselines::place_of(true_body(workshop, person, instant, master));
  if (place.norm() < kOutside) return place;
  return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
}

Claimed claimed(const Person& person) {
  if (person.carried) return {person.id.value, {person.carried->x(), person.carried->z()}};
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double count = 0.0;
  for (const SensorView& view : person.views) {
    const Eigen::Vector2d place = baselines::place_of(view.skeleton);
    if (!place.allFinite()) continue;
    sum += place;
    count += 1.0;
  }
  return {person.id.value, sum / count};
}

Grouper by_association(const associate::AssociationConfig& config) {
  return [config, tracks = associate::Tracks()](const Sights& sights) mutable {
    auto grouping = associate::group(sights, tracks, config);
    tracks = std::move(grouping.tracks);
    return std::move(grouping.people);
  };
}

Grouper by_nearest_neighbour() {
  return [neighbour = baselines::NearestNeighbour()](const Sights& sights) mutable {
    return neighbour.group(sights.views, sights.instant);
  };
}

/// Takes one sensor's own ids as they are.
Grouper by_sensor(const SensorId& sensor) {
  return [sensor](const Sights& sights) {
    std::vector<Person> people;
    for (const SensorView& view : sights.views) {
      if (view.sensor == sensor) people.push_back({PersonId{view.body.value}, {view}});
    }
    return people;
  };
}

/// The state of one method during a draw.
struct Contestant {
  std::string name;
  Grouper group;
  std::vector<Roll> rolls = {};
};

std::vector<Contestant> contestants_in(const Workshop& workshop,
                                       const std::vector<Association>& ours) {
  std::vector<Contestant> all{{"nearest-neighbour", by_nearest_neighbour()}};
  for (const Association& association : ours) {
    all.push_back({association.name, by_association(association.config)});
  }
  for (const registration::WalkTrack& track : workshop.tracks) {
    all.push_back({kBestSensor, by_sensor(track.sensor)});
  }
  return all;
}

/// The roll of an instant with everybody's true position; a method's output is added later.
Roll roll_at(const Workshop& workshop, Timestamp instant) {
  Roll roll{instant, {}, {}};
  const SensorId& master = workshop.tracks.front().sensor;
  for (std::size_t person = 0; person < workshop.scene.people.size(); ++person) {
    roll.exact.push_back(true_place(workshop, person, instant, master));
  }
  return roll;
}

Period period_of(const Workshop& workshop) {
  return {workshop.begin + kStart, workshop.begin + workshop.setting.length - kTail};
}

/// Lets every method assign the views of every instant, and records whom it reports where.
void call_rolls(const Workshop& workshop, std::vector<Contestant>& contestants) {
  const Registration places = true_registration(workshop, workshop.tracks.front().sensor);
  visit_scenes(workshop.tracks, places, period_of(workshop), [&](const Sights& sights) {
    const Roll nobody = roll_at(workshop, sights.instant);
    for (Contestant& contestant : contestants) {
      Roll roll = nobody;
      for (const Person& person : contestant.group(sights)) roll.claimed.push_back(claimed(person));
      contestant.rolls.push_back(std::move(roll));
    }
  });
}

/// True if the person's views together are closer to the truth with left and right swapped.
bool is_exchanged(const Person& person, const Skeleton<WorldSpace>& exact) {
  LabelledError sum;
  for (const SensorView& view : person.views) {
    const LabelledError error = labelled_error(view.skeleton, exact);
    sum.as_given += error.as_given;
    sum.exchanged += error.exchanged;
  }
  return sum.exchanged < sum.as_given;
}

}  // namespace

std::vector<PersonsCase> persons_cases() {
  constexpr Duration kFiveMinutes = std::chrono::minutes(5);
  constexpr Duration kMinute = std::chrono::minutes(1);
  // Profile C renders images, and the cost of occlusion grows with the square of the number of
  // people.
  constexpr Duration kRendered = std::chrono::seconds(12);
  constexpr Duration kOfFour = std::chrono::seconds(20);
  constexpr Duration kOfSix = std::chrono::seconds(15);
  return {{kCrossingTwo, "A", ring(6), crossing_two},
          {"crossing-2-B", "B", ring(6), crossing_two},
          {"crossing-2-C", "C", ring(6), crossing_two, {}, kRendered},
          {"crossing-2-ring3", "A", ring(3), crossing_two},
          {"crossing-2-close", "A", ring(3), crossing_close},
          behind_screen("crossing-2-hidden", crossing_two),
          behind_screen("booth-2", in_booth),
          behind_screen("turning-back-2", people_turning_back),
          {"crossing-2-hidden-C", "C", places_behind_screen(), crossing_two, {screen()}, kRendered},
          {"crossing-2-hidden-D", "D", places_behind_screen(), crossing_two, {screen()}},
          {"return-3-D", "D", ring(6), returning, {}, kMinute},
          {"crossing-2-pillar", "A", ring(6), crossing_two, {pillar()}},
          {"crossing-4", "A", ring(6), crossing_four, {}, kOfFour},
          {"crossing-4-B", "B", ring(6), crossing_four, {}, kOfFour},
          {"crossing-6", "A", ring(6), crossing_six, {}, kOfSix},
          {"relay-3", "A", ring(6), relayed},
          {"return-3", "A", ring(6), returning, {}, kMinute},
          beside_furniture(),
          before_furniture("furniture-all-B", ring(6)),
          before_furniture("furniture-two-B", places_behind_screen()),
          deceived("mirror-2of6", stand_a_mirror),
          deceived("agreeing-liars", let_two_lie),
          at_work_side_by_side("side-2", 6),
          at_work_side_by_side("side-2-ring3", 3),
          {"circled-2", "A", ring(6), circled_person},
          {"work-4", "A", ring(6), four_at_work, {}, kOfFour},
          {"around-2-car", "A", ring(6, 3.5), around_car, {car_body()}},
          {"around-2-table", "A", ring(6, 3.5), around_car, {table()}},
          {"four-5min", "A", ring(3), crossing_four, {}, kFiveMinutes}};
}

Identities identities_in(const PersonsCase& each, std::uint64_t seed,
                         const std::vector<Association>& ours) {
  const Workshop workshop = workshop_of(each, seed);
  std::vector<Contestant> contestants = contestants_in(workshop, ours);
  call_rolls(workshop, contestants);
  Identities identities;
  for (const Contestant& contestant : contestants) {
    const Identity found = identity_of(contestant.rolls);
    const auto [known, fresh] = identities.emplace(contestant.name, found);
    // The ids that each sensor gives take part as well, all under the same name; only the best
    // result is kept.
    if (!fresh && found.idf1 > known->second.idf1) known->second = found;
  }
  return identities;
}

double sides_wrong_in(const PersonsCase& each, std::uint64_t seed) {
  constexpr double kReach = 0.5;  // [m]
  const Workshop workshop = draw_workshop(setting_of(each, seed));
  const SensorId& master = workshop.tracks.front().sensor;
  double instants = 0.0;
  double wrong = 0.0;
  const auto look = [&](const Moment& moment) {
    for (std::size_t i = 0; i < workshop.scene.people.size(); ++i) {
      const Skeleton<WorldSpace> exact = true_body(workshop, i, moment.instant, master);
      const Eigen::Vector2d place = baselines::place_of(exact);
      const auto found = std::ranges::find_if(moment.people, [&](const Person& person) {
        return !person.views.empty() && (claimed(person).place - place).norm() <= kReach;
      });
      if (found == moment.people.end()) continue;
      instants += 1.0;
      wrong += is_exchanged(*found, exact) ? 1.0 : 0.0;
    }
  };
  visit_moments(workshop.tracks, true_registration(workshop, master), period_of(workshop), look);
  return wrong / instants;
}

}  // namespace chorus::bench
