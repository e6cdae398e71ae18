#include "fusion-server/associate/recognition.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "fusion-server/associate/assignment.h"
#include "fusion-server/associate/worn_likeness.h"

namespace chorus::associate {
namespace {

constexpr std::size_t kMostMissingTracks = 64;
// Time in view [s] after which it is decided who somebody is.  With n times as many views as
// kManyViews, a fraction 1/n of it is enough.
constexpr double kLook = 1.0;
constexpr double kManyViews = 4.0;
// Time in view [s], summed over two views at most, after which builds can exclude people.
constexpr double kGlance = 0.5;
constexpr double kSettled = 1.0;  // [s] in view after which somebody can be recognised
constexpr double kUsual = 2.0;    // [s] in view after which a build is the person's usual one
constexpr double kSure = 5.0;     // Log odds by which the likeliest answer is certain.
// The same for a newcomer, who has no id to lose.
constexpr double kSureOfNewcomer = 3.0;
// ... and who has waited for kPatience, since a wrong id is found out: where somebody known is
// taken for a person, by the cut that this makes; somebody taken for new is not asked again.
constexpr Duration kPatience = std::chrono::milliseconds(300);
constexpr double kSureOfReturning = 1.5;
constexpr double kSureOfNew = 2.2;
// The same where the id in use is certainly wrong.
constexpr double kNextOfExcluded = 0.7;
// Log odds of being the same below which a track is questioned.
constexpr double kInQuestion = 2.0;
// Log odds by which another answer has to be likelier than the id in use, after a second in view.
constexpr double kTurn = 2.0;
// Log odds, against the likeliest other answer, below which an id is withheld.
constexpr double kUnlikely = -0.5;
// What limbs that do not move as the person's inertial sensors say take from the log odds: enough
// to question an id that nothing else speaks against, not enough to exclude somebody by itself.
constexpr double kWornOdds = 4.0;
// Prior log odds that somebody is a person who is expected at that place, and that somebody who was
// recognised is still the same.
constexpr double kExpected = 1.5;
constexpr double kRecognised = 1.0;
// A newcomer not recognised within this time is taken for a new person.
constexpr Duration kNoBones = std::chrono::seconds(3);
// Two people change places within this time.
constexpr Duration kExchange = std::chrono::seconds(1);
constexpr double kNever = -std::numeric_limits<double>::infinity();

bool can_be_missing(const Build& build) { return sight_of(build) >= kSettled; }

/// Somebody who may be the person of a track.
struct Known {
  PersonId id;
  Timestamp seen;
  Build build;
  const Candidate* unseen = nullptr;  ///< The track that expects the person somewhere.
};

/// Somebody of whom it is asked who they are.
struct Question {
  Candidate* candidate = nullptr;
  Timestamp since;                      ///< From when on it is the person in question.
  Build build;                          ///< Since then.
  std::optional<Doubt> doubt = {};      ///< Of a track with an id: that the person changed.
  std::optional<std::size_t> own = {};  ///< Who had the id before, as an index of the known people.
  double turn = 0.0;  ///< Log odds by which another answer has to be likelier than the id in use.
};

struct Answer {
  std::optional<std::size_t> known;  ///< None: somebody new.
  bool decided = false;
};

Track& track_of(const Question& question) { return question.candidate->track; }

/// The doubt about a track's person: by their build, and by the inertial sensors that they wear.
std::optional<Doubt> doubt_of(const Track& track, const Repeatability& repeatability) {
  auto doubt = track.build.doubt(repeatability);
  if (doubt) doubt->odds -= kWornOdds * track.unlike;
  return doubt;
}

/// What is remembered of a track that ends: if its person probably changed, the one before.
Missing missing_of(const Track& track, const std::optional<Doubt>& doubt) {
  if (!doubt || doubt->against_new() >= 0) return {track.id, track.seen, track.build.whole()};
  return {track.id, track.build.all()[doubt->cut - 1].end, track.build.before(doubt->cut)};
}

/// What a turn needs, see Question::turn: less after a longer time in view, but where sensors show
/// people larger and smaller for seconds, it takes so much longer.
double turn_of(const Build& build, const Repeatability& repeatability) {
  return kTurn / std::max(1.0, sight_of(build) / repeatability.size);
}

/// Whether somebody's inertial sensors say that it is not them.  Then everybody is asked, since the
/// one who took their place seems to be as usual.
bool is_belied(const std::vector<Candidate>& candidates) {
  return std::ranges::any_of(candidates, [](const Candidate& each) {
    return kWornOdds * each.track.unlike >= kInQuestion;
  });
}

std::vector<Question> questions_of(std::vector<Candidate>& candidates, const Tracks& tracks,
                                   Timestamp instant, const AssociationConfig& config) {
  std::vector<Question> questions;
  const bool belied = is_belied(candidates);
  for (Candidate& each : candidates) {
    const Track& track = each.track;
    if (track.seen != instant || track.hits < config.confirm_frames) continue;
    if (!track.named) {
      questions.push_back({&each, track.found, track.build.whole()});
      continue;
    }
    if (!each.doubt || (each.doubt->odds > kInQuestion && !belied)) continue;
    const Timestamp since = track.build.all()[each.doubt->cut].begin;
    const Build build = track.build.after(each.doubt->cut);
    questions.push_back(
        {&each, since, build, each.doubt, {}, turn_of(build, tracks.repeatability)});
  }
  return questions;
}

/// Everybody who may be one of those in question; sets Question::own.
std::vector<Known> known_people(std::vector<Question>& questions,
                                const std::vector<Candidate>& candidates, const Tracks& tracks,
                                Timestamp instant) {
  std::vector<Known> known;
  for (const Missing& each : tracks.missing) known.push_back({each.id, each.seen, each.build});
  for (const Candidate& each : candidates) {
    if (!each.track.named || !each.track.admitted || each.track.seen == instant) continue;
    Missing gone = missing_of(each.track, each.doubt);
    if (can_be_missing(gone.build)) known.push_back({gone.id, gone.seen, gone.build, &each});
  }
  for (Question& question : questions) {
    if (!question.doubt) continue;
    const Track& track = track_of(question);
    question.own = known.size();
    known.push_back({track.id, track.build.all()[question.doubt->cut - 1].end,
                     track.build.before(question.doubt->cut)});
  }
  return known;
}

/// Log odds that the person in question is the known one, against somebody new.
double odds_of(const Question& question, const Known& known, const Repeatability& repeatability,
               const WornPeople& worn) {
  const double carried = question.doubt ? question.doubt->carried : 0.0;
  if (question.own && known.id == track_of(question).id) return question.doubt->odds + carried;
  const Duration late = question.doubt ? kExchange : Duration{0};
  if (known.seen > question.since + late || !can_be_missing(known.build)) return kNever;
  const double odds = likeness(question.build, known.build, repeatability);
  const bool expected =
      known.unseen &&
      horizontal_distance(track_of(question).core, known.unseen->predicted) <= known.unseen->gate;
  const auto sensors = worn.find(known.id);
  // Limbs that no view shows say nothing.
  const double unlike =
      sensors == worn.end()
          ? 0.0
          : unlike_worn(question.candidate->sights, sensors->second).value_or(0.0);
  return odds + carried + (expected ? kExpected : 0.0) - kWornOdds * unlike;
}

/// The log odds of all pairs, row by row.
CostTable odds_table(const std::vector<Question>& questions, const std::vector<Known>& known,
                     const Repeatability& repeatability, const WornPeople& worn) {
  CostTable table{questions.size(), known.size(), {}, 0.0, 0.0};
  for (const Question& question : questions) {
    for (const Known& each : known)
      table.cost.push_back(-odds_of(question, each, repeatability, worn));
  }
  return table;
}

bool is_looked_at(const Build& build) {
  return sight_of(build) * std::max(1.0, build.views / kManyViews) >= kLook;
}

bool is_glance(const Build& build) {
  return sight_of(build) * std::min(build.views, 2.0) >= kGlance;
}

/// By how much the best answer has to be likelier than the next one before the look is over.
double needed_for(const Question& question, std::optional<std::size_t> known, double gain,
                  Duration waited) {
  if (question.doubt) return known && gain > kSure ? kNextOfExcluded : kSure;
  if (waited <= kPatience) return kSureOfNewcomer;
  return known ? kSureOfReturning : kSureOfNew;
}

/// True if it can be said now that the answer in column `known`, or somebody new, is right.
bool is_decided(const Question& question, const CostTable& table, std::size_t row,
                std::optional<std::size_t> known, Timestamp instant) {
  double best = 0.0;
  double rival = known ? 0.0 : kNever;
  bool anybody = false;
  for (std::size_t i = 0; i < table.columns; ++i) {
    const double odds = -table.at(row, i);
    anybody = anybody || odds > kNever;
    (i == known ? best : rival) = i == known ? odds : std::max(rival, odds);
  }
  if (!anybody) return true;
  // An id in use is given up for a clear reason only: what is not clear yet may become so.
  const bool other = question.doubt && known != question.own;
  const double gain = other ? best + table.at(row, *question.own) : 0.0;
  if (other && gain < question.turn) return false;
  if (is_looked_at(question.build)) return true;
  const Duration waited = instant - question.since;
  if (!question.doubt && waited > kNoBones) return true;
  return is_glance(question.build) && best - rival > needed_for(question, known, gain, waited);
}

/// True if the id of `own` is given to somebody else for certain.
bool is_given_up(std::optional<std::size_t> own, const std::vector<Question>& questions,
                 const std::vector<Answer>& answers) {
  for (std::size_t i = 0; own && i < answers.size(); ++i) {
    if (answers[i].decided && answers[i].known == own && questions[i].own != own) return true;
  }
  return false;
}

/// Whoever gives up an id to somebody else gets their own answer at the same time, along the whole
/// chain of those who do.
void decide_exchanges(const std::vector<Question>& questions, std::vector<Answer>& answers) {
  for (bool more = true; more;) {
    more = false;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (answers[i].decided || !is_given_up(questions[i].own, questions, answers)) continue;
      answers[i].decided = more = true;
    }
  }
}

/// The answers that together are likeliest.
std::vector<Answer> answers_of(const std::vector<Question>& questions, const CostTable& table,
                               Timestamp instant) {
  const auto chosen = assign(table);
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < questions.size(); ++i)
    answers.push_back({chosen[i], is_decided(questions[i], table, i, chosen[i], instant)});
  decide_exchanges(questions, answers);
  return answers;
}

/// Publishes nobody under the id for as long as it takes to look, if it is probably somebody
/// else's.
void withhold(const Question& question, const CostTable& table, std::size_t row) {
  double best = 0.0;
  for (std::size_t i = 0; i < table.columns; ++i) {
    if (i != question.own) best = std::max(best, -table.at(row, i));
  }
  track_of(question).withheld = is_glance(question.build) && !is_looked_at(question.build) &&
                                -table.at(row, *question.own) < best + kUnlikely;
}

void add_missing(Missing missing, Tracks& tracks) {
  if (!can_be_missing(missing.build)) return;
  tracks.missing.push_back(std::move(missing));
  if (tracks.missing.size() > kMostMissingTracks) tracks.missing.erase(tracks.missing.begin());
}

/// Splits the track: its past becomes missing, and its present has no id yet.
void split(const Question& question, Tracks& tracks) {
  Track& track = track_of(question);
  const std::size_t cut = question.doubt->cut;
  if (track.admitted)
    add_missing({track.id, track.build.all()[cut - 1].end, track.build.before(cut)}, tracks);
  track.build.keep_after(cut);
  track.found = question.since;
  track.named = false;
  track.withheld = false;
  track.published.reset();
  track.unlike = 0.0;
}

/// What was published of a track under its id since its person changed; none if nothing was.
std::optional<Correction> wrongly_published(const Question& question) {
  const Track& track = track_of(question);
  if (!question.doubt || !track.admitted || !track.published) return std::nullopt;
  if (*track.published < question.since) return std::nullopt;
  return Correction{track.id, {}, question.since, *track.published};
}

/// Gives a missing person's id to the track.
void become(Track& track, PersonId id, std::vector<Candidate>& candidates, Tracks& tracks) {
  for (Candidate& each : candidates) {
    if (each.track.id != id || &each.track == &track || !each.track.named) continue;
    miss(each.track, tracks);
    each.track.id = PersonId{};  // This candidate is removed later.
  }
  track.id = id;
  const auto missing = std::ranges::find(tracks.missing, id, &Missing::id);
  if (missing == tracks.missing.end()) return;
  track.build.precede(missing->build, missing->seen, kRecognised);
  tracks.missing.erase(missing);
}

/// Learns from a person who stays in view how well the sensors repeat a build.
void learn(const Track& track, Repeatability& repeatability) {
  const auto all = track.build.all();
  if (!track.named || all.empty() || sight_of(all.back().build) < 1.0) return;
  const Build usual = track.build.before(all.size() - 1);
  if (sight_of(usual) < kUsual) return;
  const auto doubt = doubt_of(track, repeatability);
  if (!doubt || doubt->odds > kInQuestion) repeatability.learn(all.back().build, usual);
}

/// Computes the doubt about a track, and by it the person's usual build.
void renew_usual(Candidate& candidate, const Repeatability& repeatability) {
  candidate.doubt = doubt_of(candidate.track, repeatability);
  candidate.track.usual = missing_of(candidate.track, candidate.doubt).build;
}

/// Names those for whom it is decided.
std::vector<Correction> apply(const std::vector<Question>& questions,
                              const std::vector<Answer>& answers, const std::vector<Known>& known,
                              std::vector<Candidate>& candidates, Tracks& tracks) {
  std::vector<std::size_t> changed;
  std::vector<std::optional<Correction>> wrong;
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (!answers[i].decided || (questions[i].own && answers[i].known == questions[i].own)) continue;
    changed.push_back(i);
    wrong.push_back(wrongly_published(questions[i]));
    if (questions[i].doubt) split(questions[i], tracks);
  }
  std::vector<Correction> corrections;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const Question& question = questions[changed[i]];
    Track& track = track_of(question);
    if (const auto who = answers[changed[i]].known) {
      become(track, known[*who].id, candidates, tracks);
    } else if (question.doubt) {
      track.id = PersonId{tracks.next_id++};
    }
    track.named = true;
    renew_usual(*question.candidate, tracks.repeatability);
    if (!wrong[i]) continue;
    wrong[i]->person = track.id;
    corrections.push_back(*wrong[i]);
  }
  return corrections;
}

}  // namespace

void miss(const Track& track, Tracks& tracks) {
  if (track.named && track.admitted)
    add_missing(missing_of(track, doubt_of(track, tracks.repeatability)), tracks);
}

void forget(Tracks& tracks, Timestamp instant, const AssociationConfig& config) {
  std::erase_if(tracks.missing, [&](const Missing& each) {
    return instant < each.seen || instant - each.seen > config.remember;
  });
}

void forget(PersonId person, Tracks& tracks) {
  const auto is_this = [&](const auto& each) { return each.id == person; };
  std::erase_if(tracks.people, is_this);
  std::erase_if(tracks.missing, is_this);
}

std::vector<Correction> recognise(std::vector<Candidate>& candidates, Tracks& tracks,
                                  const Asked& asked, const AssociationConfig& config) {
  const Timestamp instant = asked.at;
  for (const Candidate& each : candidates) {
    // A view that only turns the track adds nothing to its build.
    if (each.track.placed == instant) learn(each.track, tracks.repeatability);
  }
  for (Candidate& each : candidates) {
    each.doubt = doubt_of(each.track, tracks.repeatability);
    if (each.track.placed == instant) each.track.usual = missing_of(each.track, each.doubt).build;
  }
  std::vector<Question> questions = questions_of(candidates, tracks, instant, config);
  const std::vector<Known> known = known_people(questions, candidates, tracks, instant);
  const CostTable table = odds_table(questions, known, tracks.repeatability, asked.worn);
  const std::vector<Answer> answers = answers_of(questions, table, instant);
  for (Candidate& each : candidates) {
    if (each.track.seen == instant) each.track.withheld = false;
  }
  for (std::size_t i = 0; i < questions.size(); ++i) {
    if (questions[i].doubt) withhold(questions[i], table, i);
  }
  auto corrections = apply(questions, answers, known, candidates, tracks);
  std::erase_if(candidates, [](const Candidate& each) { return each.track.id == PersonId{}; });
  return corrections;
}

}  // namespace chorus::associate
