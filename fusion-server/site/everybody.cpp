#include "fusion-server/site/everybody.h"

#include <algorithm>

namespace chorus::site {
namespace {

/// One cell's word on a person.
struct Word {
  const HeardCell* cell = nullptr;
  const HeardBody* body = nullptr;
  double certainty = 0.0;
};

using Words = std::map<SiteId, std::vector<Word>>;

void add_others(Words& words, const Hearing& hearing, const Names& names,
                const SiteConfig& config) {
  for (const auto& [id, cell] : *hearing.others) {
    if (!cell.place || !cell.live(hearing.now, config.lease)) continue;
    for (const auto& [body, heard] : cell.bodies) {
      if (heard.last.site_id)
        words[names.present(*heard.last.site_id)].push_back(
            {&cell, &heard, heard.last.site_certainty});
    }
  }
}

void add_own(Words& words, const Hearing& hearing, const Names& names) {
  if (!hearing.ours->place) return;
  for (const auto& [body, name] : names.all()) {
    const auto heard = hearing.ours->bodies.find(body);
    if (name.id && heard != hearing.ours->bodies.end())
      words[*name.id].push_back({hearing.ours, &heard->second, name.certainty});
  }
}

/// The word that counts, of one or more.
const Word& counting(const std::vector<Word>& words, const std::optional<CellId>& holder,
                     const SiteConfig& config) {
  const auto rank = [&](const Word& word) {
    const bool held = holder && word.cell->id == *holder;
    return std::tuple(!word.body->seen(), !held,
                      stated_variance(word.body->last.covariance, config), word.cell->id);
  };
  return *std::ranges::min_element(words, {}, rank);
}

SitePerson person_of(const SiteId& id, const Word& word, const HeardCell& ours,
                     const SiteConfig& config) {
  const Eigen::Isometry3d& place = word.cell->place->site_from_cell;
  const Person& told = word.body->last;
  SitePerson person;
  person.id = id;
  person.certainty = word.certainty;
  person.cell = word.cell->id;
  person.body = told.body;
  person.at = word.cell->at + ours.place.value_or(CellPlace{}).clock_added;
  const Sample where = in_site(place, {word.cell->at, told.place, told.velocity, told.covariance});
  person.place = where.place;
  person.velocity = where.velocity;
  person.covariance = where.covariance;
  person.cell_covariance = covariance_at(*word.cell->place, where.place, config);
  for (std::size_t i = 0; i < kJointCount; ++i) {
    if (told.joints[i]) person.joints[i] = place * *told.joints[i];
  }
  return person;
}

}  // namespace

double stated_variance(const Eigen::Matrix3d& covariance, const SiteConfig& config) {
  const double stated = 0.5 * (covariance(0, 0) + covariance(2, 2));
  return stated > 0 ? stated : config.unknown_place_sigma * config.unknown_place_sigma;
}

std::vector<SitePerson> everybody_of(const Hearing& hearing, const Names& names,
                                     const SiteConfig& config) {
  Words words;
  add_others(words, hearing, names, config);
  add_own(words, hearing, names);
  std::vector<SitePerson> all;
  for (const auto& [id, told] : words) {
    const Word& word = counting(told, hearing.ownership->holder(id), config);
    SitePerson person = person_of(id, word, *hearing.ours, config);
    for (const Word& each : told) person.seen_by.push_back(each.cell->id);
    all.push_back(std::move(person));
  }
  return all;
}

}  // namespace chorus::site
