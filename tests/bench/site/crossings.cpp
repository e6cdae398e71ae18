#include "tests/bench/site/crossings.h"

namespace chorus::bench {
namespace {

constexpr double kLongestGap = 4.0;     // [s]
constexpr double kShortestVisit = 1.0;  // [s]; whoever only touches a cell is not counted
constexpr double kDoubled = 1.0;        // [s]

}  // namespace

void Crossings::begin(double time, const SeenAs& seen) {
  Visit visit;
  visit.begin = visit.last = time;
  const auto last = last_.find(seen.person);
  if (last != last_.end()) {
    visit.before = last->second.id;
    const double gap = time - last->second.at;
    visit.overlap = gap < 1.5 * period_;
    visit.counted = gap <= kLongestGap;
  }
  visits_[{seen.cell, seen.person}] = visit;
}

void Crossings::end(std::size_t person, const Visit& visit) {
  if (visit.last - visit.begin < kShortestVisit || !visit.counted || visit.before.empty()) return;
  CrossingCount& count = visit.overlap ? score_.overlap : score_.gap;
  ++count.all;
  if (visit.first == visit.before && visit.ids.size() == 1) ++count.kept;
  bool wrong = false;
  bool unsaid = false;
  for (const std::string& id : visit.ids) {
    if (id == visit.before || owner_.at(id) == person) continue;
    wrong = true;
    unsaid |= visit.unsaid.contains(id);
  }
  count.wrong += wrong ? 1 : 0;
  count.wrong_unsaid += unsaid ? 1 : 0;
}

void Crossings::end_old(double time) {
  for (auto at = visits_.begin(); at != visits_.end();) {
    if (time - at->second.last < 1.5 * period_) {
      ++at;
      continue;
    }
    end(at->first.second, at->second);
    at = visits_.erase(at);
  }
}

void Crossings::count_doubles(const std::vector<SeenAs>& seen) {
  std::map<std::size_t, std::set<std::string>> borne;
  for (const SeenAs& each : seen) {
    if (!each.id.empty()) borne[each.person].insert(each.id);
  }
  for (const auto& [person, ids] : borne) {
    double& lasted = doubled_for_[person];
    const double before = lasted;
    lasted = ids.size() > 1 ? lasted + period_ : 0.0;
    if (before < kDoubled && lasted >= kDoubled) ++doubles_;
  }
}

void Crossings::add(double time, const std::vector<SeenAs>& seen) {
  if (begun_ < 0) begun_ = time;
  now_ = time;
  end_old(time);
  for (const SeenAs& each : seen) {
    if (!visits_.contains({each.cell, each.person})) begin(time, each);
  }
  for (const SeenAs& each : seen) {
    Visit& visit = visits_.at({each.cell, each.person});
    visit.last = time;
    Last& last = last_[each.person];
    last.at = time;
    if (each.id.empty()) continue;
    owner_.emplace(each.id, each.person);
    if (visit.first.empty()) {
      visit.first = each.id;
      score_.first_id.push_back(time - visit.begin);
    }
    visit.ids.insert(each.id);
    if (!each.doubtful) visit.unsaid.insert(each.id);
    ++named_;
    doubtful_ += each.doubtful ? 1 : 0;
  }
  // The id to keep is that of the cell that has seen the person for longest.
  std::map<std::size_t, double> since;
  for (const SeenAs& each : seen) {
    const double begin = visits_.at({each.cell, each.person}).begin;
    const auto [at, fresh] = since.try_emplace(each.person, begin);
    if (each.id.empty() || (!fresh && begin > at->second)) continue;
    at->second = begin;
    last_[each.person].id = each.id;
  }
  count_doubles(seen);
}

CrossingScore Crossings::score() {
  for (const auto& [key, visit] : visits_) end(key.second, visit);
  visits_.clear();
  const double minutes = (now_ - begun_) / 60.0;
  score_.doubled_per_minute = minutes > 0 ? static_cast<double>(doubles_) / minutes : 0.0;
  score_.doubtful_percent =
      named_ > 0 ? 100.0 * static_cast<double>(doubtful_) / static_cast<double>(named_) : 0.0;
  return score_;
}

}  // namespace chorus::bench
