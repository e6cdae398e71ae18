#include "fusion-server/nats/cell_cards.h"

#include "fusion-server/nats/inbox.h"

namespace chorus::nats {
namespace {

/// Of one cell.
bool older(const CellCard& one, const CellCard& other) {
  const auto version = [](const CellCard& card) { return card.place ? card.place->version : 0; };
  return one.boot != other.boot ? one.boot < other.boot : version(one) < version(other);
}

}  // namespace

Result<bool> CellCards::hear(const CellCard& card) {
  const auto known = cards_.find(card.cell);
  if (known == cards_.end() && cards_.size() == Inbox<CellCard>::kCells)
    return fail(ErrorCode::TooLarge, "card", "there are too many cells");
  if (known != cards_.end() && older(card, known->second)) return false;
  cards_[card.cell] = card;
  return true;
}

std::vector<site::KnownCell> CellCards::known(const std::vector<site::CellState>& cells,
                                              const CellCard& own) const {
  std::vector<site::KnownCell> all;
  for (const site::CellState& state : cells) {
    const auto found = cards_.find(state.cell);
    const CellCard told_of = state.cell == own.cell  ? own
                             : found == cards_.end() ? CellCard{}
                                                     : found->second;
    all.push_back({state, told_of.url, told_of.software, told_of.place});
  }
  return all;
}

}  // namespace chorus::nats
