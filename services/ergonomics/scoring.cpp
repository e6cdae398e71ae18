#include "services/ergonomics/scoring.h"

#include <algorithm>

#include <fmt/format.h>

#include "common/assessment/people.h"

namespace chorus::ergonomics_service {
namespace {

constexpr Duration kForgetAfter = std::chrono::seconds(10);

}  // namespace

Scoring::Scoring(std::vector<const ergonomics::Method*> methods,
                 std::vector<ergonomics::PostureRule> rules)
    : methods_(std::move(methods)), rules_(std::move(rules)) {}

const ScoreFrame& Scoring::latest() const { return kept_.back(); }

const ScoreFrame* Scoring::at(Timestamp at) const {
  const ScoreFrame* nearest = nullptr;
  if (at > kept_.back().captured) return nullptr;
  for (const ScoreFrame& frame : kept_) {
    if (frame.sequence == 0) continue;
    if (nearest == nullptr ||
        std::chrono::abs(frame.captured - at) < std::chrono::abs(nearest->captured - at))
      nearest = &frame;
  }
  // Before the first kept instant nothing is known any more.
  constexpr Duration kNear = std::chrono::milliseconds(500);
  return nearest != nullptr && std::chrono::abs(nearest->captured - at) <= kNear ? nearest
                                                                                 : nullptr;
}

Scoring::Watched& Scoring::watched(std::uint64_t person, Timestamp at) {
  auto found = people_.find(person);
  if (found == people_.end()) {
    found = people_
                .emplace(person, Watched{ergonomics::Observer(),
                                         ergonomics::PostureWatch(rules_),
                                         std::vector<ergonomics::ShownScore>(methods_.size()),
                                         {},
                                         Stance::Missing,
                                         {},
                                         {},
                                         at})
                .first;
  }
  found->second.last = at;
  return found->second;
}

Result<void> Scoring::ask_stance(std::uint64_t person) {
  const auto found = people_.find(person);
  if (found == people_.end())
    return fail(ErrorCode::NotFound, fmt::format("person {}", person), "is not seen");
  Watched& watched = found->second;
  watched.stance = Stance::Asked;
  watched.standing.clear();
  watched.trouble.clear();
  watched.asked = watched.last;
  watched.observer.forget_stance();
  return {};
}

/// Two seconds after it was asked for, the stance is known or there is a reason why not.
void Scoring::watch_stance(Watched& person, const ergonomics::BodyAt& body) {
  if (person.stance != Stance::Asked) return;
  if (!body.carried) person.standing.push_back({body.at, posture::posture_of(body.body).measures});
  if (body.at - person.asked < posture::kStanceLasts) return;
  auto neutral = posture::neutral_of(person.standing);
  person.standing.clear();
  person.stance = neutral ? Stance::Known : Stance::Missing;
  person.trouble = neutral ? std::string() : to_string(neutral.error());
  if (neutral) person.observer.stance(std::move(*neutral));
}

PersonScores Scoring::scored(std::uint64_t id, const ergonomics::BodyAt& body) {
  Watched& person = watched(id, body.at);
  watch_stance(person, body);
  const ergonomics::Observation seen = person.observer.observe(body);
  PersonScores out;
  out.person = id;
  out.captured = body.at;
  out.reason = seen.reason;
  out.stance = person.stance;
  out.stance_trouble = person.trouble;
  for (std::size_t m = 0; m < methods_.size(); ++m) {
    out.scores.push_back(score_of(*methods_[m], seen, asked_));
    out.shown.push_back(person.shown[m].follow(body.at, out.scores.back().score));
  }
  (void)person.postures.add(seen);
  out.postures = person.postures.current();
  return out;
}

const ScoreFrame& Scoring::take(const resource::FrameResource& frame) {
  if (kept_.back().sequence != 0 && frame.captured <= kept_.back().captured) return kept_.back();
  ScoreFrame scores{frame.sequence, frame.captured, {}};
  for (const resource::BodyResource& body : frame.bodies)
    scores.persons.push_back(scored(body.id, assessment::body_at(body, frame.captured)));
  std::erase_if(people_,
                [&](const auto& each) { return frame.captured - each.second.last > kForgetAfter; });
  kept_.push_back(std::move(scores));
  while (kept_.size() > 1 && frame.captured - kept_.front().captured > kKept) kept_.pop_front();
  return kept_.back();
}

}  // namespace chorus::ergonomics_service
