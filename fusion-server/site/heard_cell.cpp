#include "fusion-server/site/heard_cell.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

namespace chorus::site {
namespace {

constexpr double kFarthestStated = 1000.0;  // [m] from a cell's origin
constexpr double kFastestStated = 15.0;     // [m/s]; a sprinter makes 12
// Another boot of a cell that spoke within this time is another cell of the same name.
constexpr Duration kRestart = std::chrono::milliseconds(500);
// A velocity is that of a time between these two [s]: in a shorter one, noise moves people.
constexpr double kShortestWay = 0.2;
constexpr double kLongestWay = 0.5;

tl::unexpected<Error> refuse(const CellId& cell, std::string why) {
  return fail(ErrorCode::InvalidArgument, "cell " + cell.str(), std::move(why));
}

bool sound(const Person& person) {
  const Eigen::Matrix3d& c = person.covariance;
  return person.place.allFinite() && person.place.norm() <= kFarthestStated &&
         person.velocity.allFinite() && person.velocity.norm() <= kFastestStated && c.allFinite() &&
         c.diagonal().minCoeff() >= 0 && person.site_certainty >= 0 && person.site_certainty <= 1;
}

Result<void> check_people(const CellPeople& message, const SiteConfig& config) {
  if (message.people.size() > config.max_people)
    return refuse(message.cell,
                  fmt::format("{} people; at most {}", message.people.size(), config.max_people));
  std::set<PersonId> bodies;
  std::set<SiteId> names;
  for (const Person& person : message.people) {
    if (!sound(person))
      return refuse(message.cell, fmt::format("person {}: a place, velocity, covariance or "
                                              "certainty out of range",
                                              person.body.value));
    if (!bodies.insert(person.body).second)
      return refuse(message.cell, fmt::format("two people {}", person.body.value));
    if (person.site_id && !names.insert(*person.site_id).second)
      return refuse(message.cell, "two people are " + person.site_id->str());
  }
  return {};
}

Result<void> check_time(const HeardCell& cell, const CellPeople& message, Timestamp now,
                        const SiteConfig& config) {
  const Timestamp at = message.at + cell.to_ours;
  if (at > now + config.max_ahead)
    return refuse(cell.id,
                  fmt::format("its clock is {:.1f} s ahead of ours: synchronise the clocks",
                              seconds(at - now)));
  if (now > at + config.max_age)
    return refuse(cell.id, fmt::format("the message is {:.1f} s old: its clock is behind ours, or "
                                       "the network is slow",
                                       seconds(now - at)));
  return {};
}

Result<void> check_order(HeardCell& cell, const CellPeople& message, Timestamp now) {
  if (cell.sequence == 0) return {};
  if (message.boot != cell.boot) {
    if (now - cell.heard > kRestart) return {};
    ++cell.twice;
    return refuse(cell.id, "another cell has the same name: rename one of them");
  }
  if (message.sequence <= cell.sequence || message.at + cell.to_ours <= cell.at)
    return refuse(cell.id,
                  fmt::format("message {} comes after {}", message.sequence, cell.sequence));
  return {};
}

void hear_person(HeardCell& cell, const Person& person, Timestamp now) {
  const auto [at, fresh] = cell.bodies.try_emplace(person.body);
  HeardBody& body = at->second;
  if (fresh) {
    body.found = now;
    body.appeared = person.place;
    body.appeared_at = cell.at;
  }
  const double elapsed = seconds(cell.at - body.appeared_at);
  if (elapsed >= kShortestWay && elapsed <= kLongestWay)
    body.came_with = (person.place - body.appeared) / elapsed;
  if (fresh || body.last.site_id != person.site_id) body.named = now;
  body.last = person;
  if (body.seen()) body.trail.add({cell.at, person.place, person.velocity, person.covariance});
}

}  // namespace

Result<void> hear(HeardCell& cell, const CellPeople& message, Timestamp now,
                  const SiteConfig& config) {
  for (const Result<void>& checked :
       {check_people(message, config), check_time(cell, message, now, config),
        check_order(cell, message, now)}) {
    if (checked) continue;
    ++cell.refused;
    return checked;
  }
  if (message.boot != cell.boot) {  // it has started again, and its ids with it
    cell.bodies.clear();
    cell.windows.clear();
    cell.likely.clear();
  }
  cell.boot = message.boot;
  cell.sequence = message.sequence;
  cell.heard = now;
  cell.at = message.at + cell.to_ours;
  std::set<PersonId> told;
  for (const Person& person : message.people) {
    hear_person(cell, person, now);
    told.insert(person.body);
  }
  std::erase_if(cell.bodies, [&](const auto& each) { return !told.contains(each.first); });
  const auto gone = [&](const auto& each) { return !told.contains(each.first.second); };
  std::erase_if(cell.windows, gone);
  std::erase_if(cell.likely, gone);
  return {};
}

Sample in_site(const Eigen::Isometry3d& site_from_cell, const Sample& sample) {
  const Eigen::Matrix3d turn = site_from_cell.linear();
  return {sample.at, site_from_cell * sample.place, turn * sample.velocity,
          turn * sample.covariance * turn.transpose()};
}

}  // namespace chorus::site
