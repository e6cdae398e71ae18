#include "common/workplace/prop_board.h"

#include <algorithm>
#include <string>

namespace chorus::workplace {

std::vector<Holding> PropBoard::holdings() const {
  const std::scoped_lock lock(mutex_);
  return holdings_;
}

Result<std::size_t> PropBoard::index_of(std::string_view prop) const {
  const auto found = std::ranges::find(props_, prop, &Prop::name);
  if (found != props_.end()) return static_cast<std::size_t>(found - props_.begin());
  std::string known;
  for (const Prop& each : props_) known += (known.empty() ? "" : ", ") + each.name;
  return fail(ErrorCode::NotFound, std::string(prop),
              known.empty() ? "is no prop; the configuration names none (props)"
                            : "is no prop; there are: " + known);
}

Result<void> PropBoard::take_up(std::string_view prop, std::uint64_t person) {
  const auto index = index_of(prop);
  if (!index) return pass(index);
  const std::scoped_lock lock(mutex_);
  Holding& holding = holdings_[*index];
  if (holding.person != person) holding = {person, holding.change + 1};
  return {};
}

Result<void> PropBoard::put_down(std::string_view prop) {
  const auto index = index_of(prop);
  if (!index) return pass(index);
  const std::scoped_lock lock(mutex_);
  Holding& holding = holdings_[*index];
  if (holding.person) holding = {std::nullopt, holding.change + 1};
  return {};
}

HeldProps::HeldProps(std::shared_ptr<const PropBoard> board)
    : board_(std::move(board)), props_(board_->props().size()) {
  for (const Prop& prop : board_->props()) held_.emplace_back(prop);
}

std::vector<PropAt> HeldProps::follow(Timestamp at, const std::vector<Holder>& people) {
  const std::vector<Holding> holdings = board_->holdings();
  for (std::size_t i = 0; i < props_.size(); ++i) {
    PropAt& prop = props_[i];
    if (holdings[i].change != prop.holding.change) held_[i] = HeldProp(board_->props()[i]);
    prop.holding = holdings[i];
    prop.tracked = false;
    if (!prop.holding.person) continue;
    const auto holder = std::ranges::find(people, *prop.holding.person, &Holder::person);
    if (holder == people.end()) continue;
    if (auto pose = held_[i].follow(at, *holder->body)) {
      prop.pose = pose;
      prop.tracked = true;
    }
  }
  return props_;
}

}  // namespace chorus::workplace
