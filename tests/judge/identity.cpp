#include "tests/judge/identity.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "common/base/duration.h"
#include "fusion-server/associate/assignment.h"

namespace chorus::bench {
namespace {

using associate::CostTable;

struct Followed {
  std::optional<std::uint64_t> now;   ///< Id at the present instant.
  std::optional<std::uint64_t> last;  ///< Id at the last instant at which the person was reported.
  std::optional<Timestamp> came;      ///< The person's first instant in the room.
  std::optional<Timestamp> answered;  ///< The first instant at which the person was reported.
};

/// The longest of the spells in which something is so, each of which belongs to somebody.
class Spells {
 public:
  void note(std::uint64_t whose, bool is_so, Timestamp now) {
    if (!is_so) {
      began_.erase(whose);
      return;
    }
    const Timestamp since = began_.try_emplace(whose, now).first->second;
    longest_ = std::max(longest_, seconds(now - since));
  }
  /// Ends the spells of all but those of whom `is_here` is true.
  template <class IsHere>
  void keep(const IsHere& is_here) {
    std::erase_if(began_, [&](const auto& entry) { return !is_here(entry.first); });
  }
  [[nodiscard]] double longest() const { return longest_; }

 private:
  std::map<std::uint64_t, Timestamp> began_;
  double longest_ = 0.0;
};

/// Counts all figures in one pass over the instants.
class Census {
 public:
  explicit Census(const IdentityConfig& config) : config_(config) {}

  void take(const Roll& roll) {
    ++instants_;
    people_.resize(std::max(people_.size(), roll.exact.size()));
    const auto before = people_;
    for (Followed& person : people_) person.now.reset();
    std::vector<bool> taken(roll.claimed.size(), false);
    keep(roll, before, taken);
    assign_rest(roll, taken);
    count(roll, before);
    time_spells(roll);
  }

  [[nodiscard]] Identity result(double minutes) const {
    Identity found;
    found.switches = switches_;
    found.fragmentations = fragmentations_;
    found.minutes = minutes;
    found.coverage = present_ > 0 ? share(answered_, present_) : 0.0;
    for (const auto& [id, life] : lives_) {
      const auto follows = followed_.find(id);
      const double followed = follows == followed_.end() ? 0.0 : share(follows->second, life);
      found.ghosts += followed < config_.ghost ? 1U : 0U;
    }
    found.first_answer = first_answer();
    found.longest_false = false_.longest();
    found.longest_unseen = unseen_.longest();
    if (minutes > 0) count_heirs(found, static_cast<double>(instants_) / (60.0 * minutes));
    const std::size_t all = present_ + claims_;
    found.idf1 = all > 0 ? 2.0 * share(true_positives(), all) : 0.0;
    return found;
  }

 private:
  static double share(std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(whole);
  }

  [[nodiscard]] double distance(const Roll& roll, std::size_t person, std::size_t claim) const {
    const double found = (roll.exact[person] - roll.claimed[claim].place).norm();
    return found <= config_.reach ? found : std::numeric_limits<double>::quiet_NaN();
  }

  void keep(const Roll& roll, const std::vector<Followed>& before, std::vector<bool>& taken) {
    for (std::size_t p = 0; p < roll.exact.size(); ++p) {
      for (std::size_t c = 0; c < roll.claimed.size(); ++c) {
        const bool same = before[p].last == roll.claimed[c].id;
        if (!same || taken[c] || !(distance(roll, p, c) <= config_.reach)) continue;
        people_[p].now = roll.claimed[c].id;
        taken[c] = true;
      }
    }
  }

  void assign_rest(const Roll& roll, const std::vector<bool>& taken) {
    std::vector<std::size_t> people;
    std::vector<std::size_t> claims;
    for (std::size_t p = 0; p < roll.exact.size(); ++p) {
      if (!people_[p].now) people.push_back(p);
    }
    for (std::size_t c = 0; c < taken.size(); ++c) {
      if (!taken[c]) claims.push_back(c);
    }
    CostTable table{people.size(), claims.size(), {}, config_.reach};
    for (const std::size_t p : people) {
      for (const std::size_t c : claims) table.cost.push_back(distance(roll, p, c));
    }
    const auto chosen = associate::assign(table);
    for (std::size_t i = 0; i < people.size(); ++i) {
      if (chosen[i]) people_[people[i]].now = roll.claimed[claims[*chosen[i]]].id;
    }
  }

  void count(const Roll& roll, const std::vector<Followed>& before) {
    for (const Claimed& claim : roll.claimed) ++lives_[claim.id];
    claims_ += roll.claimed.size();
    for (std::size_t p = 0; p < roll.exact.size(); ++p) {
      if (!roll.exact[p].allFinite()) continue;
      ++present_;
      Followed& person = people_[p];
      if (!person.came) person.came = roll.instant;
      if (!person.now) continue;
      ++answered_;
      if (!person.answered) person.answered = roll.instant;
      ++followed_[*person.now];
      ++together_[{p, *person.now}];
      switches_ += person.last && person.last != person.now ? 1U : 0U;
      fragmentations_ += person.last && !before[p].now ? 1U : 0U;
      person.last = person.now;
    }
  }

  void time_spells(const Roll& roll) {
    false_.keep([&](std::uint64_t id) {
      return std::ranges::find(roll.claimed, id, &Claimed::id) != roll.claimed.end();
    });
    for (const Claimed& claim : roll.claimed) {
      const auto is_near = [&](const Eigen::Vector2d& place) {
        return (place - claim.place).norm() <= config_.reach;
      };
      false_.note(claim.id, std::ranges::none_of(roll.exact, is_near), roll.instant);
    }
    for (std::size_t p = 0; p < roll.exact.size(); ++p)
      unseen_.note(p, roll.exact[p].allFinite() && !people_[p].now, roll.instant);
  }

  /// Counts `inherited` and `spare_ids`; `rate` is in instants per second.
  void count_heirs(Identity& found, double rate) const {
    std::map<std::uint64_t, std::size_t> people;  // number of people that an id followed
    std::map<std::size_t, std::size_t> ids;       // number of ids that mostly followed a person
    for (const auto& [pair, count] : together_) {
      const auto& [person, id] = pair;
      if (static_cast<double>(count) < rate * config_.lasting) continue;
      found.inherited += people[id]++ > 0 ? 1U : 0U;
      const bool mostly = share(count, lives_.at(id)) >= config_.ghost;
      found.spare_ids += mostly && ids[person]++ > 0 ? 1U : 0U;
    }
  }

  [[nodiscard]] double first_answer() const {
    double sum = 0.0;
    std::size_t count = 0;
    for (const Followed& person : people_) {
      if (!person.answered) continue;
      sum += seconds(*person.answered - *person.came);
      ++count;
    }
    return count > 0 ? sum / static_cast<double>(count) : 0.0;
  }

  /// Number of instants matched by the best one-to-one assignment of people to ids over all time.
  [[nodiscard]] std::size_t true_positives() const {
    std::vector<std::uint64_t> ids;
    for (const auto& [id, life] : lives_) ids.push_back(id);
    const auto most = static_cast<double>(claims_ + 1);
    CostTable table{people_.size(), ids.size(), {}, most};
    const auto shared = [&](std::size_t person, std::uint64_t id) {
      const auto at = together_.find({person, id});
      return at == together_.end() ? std::size_t{0} : at->second;
    };
    for (std::size_t p = 0; p < people_.size(); ++p) {
      for (const std::uint64_t id : ids) {
        table.cost.push_back(most - static_cast<double>(shared(p, id)));
      }
    }
    const auto chosen = associate::assign(table);
    std::size_t sum = 0;
    for (std::size_t p = 0; p < chosen.size(); ++p)
      sum += chosen[p] ? shared(p, ids[*chosen[p]]) : 0;
    return sum;
  }

  const IdentityConfig& config_;
  std::vector<Followed> people_;
  std::map<std::uint64_t, std::size_t> lives_;
  std::map<std::uint64_t, std::size_t> followed_;
  std::map<std::pair<std::size_t, std::uint64_t>, std::size_t> together_;
  std::size_t instants_ = 0;
  std::size_t claims_ = 0;
  std::size_t present_ = 0;
  std::size_t answered_ = 0;
  std::size_t switches_ = 0;
  std::size_t fragmentations_ = 0;
  Spells false_;   // by id
  Spells unseen_;  // by person
};

}  // namespace

Identity identity_of(const std::vector<Roll>& rolls, const IdentityConfig& config) {
  Census census(config);
  for (const Roll& roll : rolls) census.take(roll);
  const double span = rolls.empty() ? 0.0 : seconds(rolls.back().instant - rolls.front().instant);
  return census.result(span / 60.0);
}

}  // namespace chorus::bench
