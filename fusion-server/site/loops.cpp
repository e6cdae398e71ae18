#include "fusion-server/site/loops.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <queue>
#include <set>

namespace chorus::site {
namespace {

using Links = std::vector<PairwiseRegistration>;

bool joins(const PairwiseRegistration& link, const CellId& cell) {
  return link.target == cell || link.source == cell;
}

const CellId& far_end(const PairwiseRegistration& link, const CellId& near_end) {
  return link.target == near_end ? link.source : link.target;
}

std::set<CellId> cells_of(const Links& links) {
  std::set<CellId> all;
  for (const auto& link : links) all.insert({link.target, link.source});
  return all;
}

/// Mean variance of a link's place, per axis [m^2].
double variance_of(const PairwiseRegistration& link) {
  return link.covariance.bottomRightCorner<3, 3>().trace() / 3.0;
}

/// Each cell's way towards the root of its tree.
struct Tree {
  std::map<CellId, const PairwiseRegistration*> up;  ///< Null: a root.
  std::map<CellId, std::size_t> depth;
};

Tree tree_of(const Links& links) {
  Tree tree;
  for (const CellId& root : cells_of(links)) {
    if (tree.up.contains(root)) continue;
    tree.up[root] = nullptr;
    tree.depth[root] = 0;
    std::queue<CellId> next;
    for (next.push(root); !next.empty(); next.pop()) {
      const CellId at = next.front();
      std::vector<const PairwiseRegistration*> ways;
      for (const auto& link : links) {
        if (joins(link, at) && !tree.up.contains(far_end(link, at))) ways.push_back(&link);
      }
      std::ranges::sort(ways, {}, [](const auto* link) { return variance_of(*link); });
      for (const auto* link : ways) {
        const CellId& cell = far_end(*link, at);
        if (!tree.up.emplace(cell, link).second) continue;
        tree.depth[cell] = tree.depth[at] + 1;
        next.push(cell);
      }
    }
  }
  return tree;
}

/// The links on the way from `from` to `to`, both in one tree.
std::vector<const PairwiseRegistration*> way(const Tree& tree, CellId from, CellId to) {
  std::vector<const PairwiseRegistration*> ahead;
  std::vector<const PairwiseRegistration*> back;
  while (from != to) {
    const bool deeper = tree.depth.at(from) >= tree.depth.at(to);
    CellId& lower = deeper ? from : to;
    const PairwiseRegistration* link = tree.up.at(lower);
    if (link == nullptr) return {};
    (deeper ? ahead : back).push_back(link);
    lower = far_end(*link, lower);
  }
  ahead.insert(ahead.end(), back.rbegin(), back.rend());
  return ahead;
}

CellLoop loop_along(const CellId& begin, const std::vector<const PairwiseRegistration*>& links) {
  CellLoop loop;
  Eigen::Isometry3d begin_from_here = Eigen::Isometry3d::Identity();
  CellId at = begin;
  double variance = 0.0;
  for (const auto* link : links) {
    loop.cells.push_back(at);
    const bool forward = link->target == at;
    begin_from_here =
        begin_from_here * (forward ? link->target_from_source : link->target_from_source.inverse());
    variance += variance_of(*link);
    at = far_end(*link, at);
    // The turn of a link counts at the distance that the loop goes from there.
    const double turn = link->covariance(1, 1);
    variance += turn * begin_from_here.translation().squaredNorm() / 3.0;
  }
  loop.closure = begin_from_here.translation().norm();
  loop.expected = std::sqrt(3.0 * variance);
  return loop;
}

Links without(const Links& links, const CellId& cell) {
  Links rest;
  std::ranges::copy_if(links, std::back_inserter(rest),
                       [&](const auto& link) { return !joins(link, cell); });
  return rest;
}

/// Closures of the open loops that the cell is in; each loop that closes speaks for it.
double blame_of(const std::vector<CellLoop>& loops, const LoopLimits& limits, const CellId& cell) {
  double sum = 0.0;
  for (const CellLoop& loop : loops) {
    if (std::ranges::count(loop.cells, cell) == 0) continue;
    sum += closes(loop, limits) ? -limits.least : loop.closure;
  }
  return sum;
}

}  // namespace

std::vector<CellLoop> loops_of(const Links& links) {
  const Tree tree = tree_of(links);
  std::set<const PairwiseRegistration*> in_tree;
  for (const auto& [cell, link] : tree.up) in_tree.insert(link);
  std::vector<CellLoop> loops;
  for (const auto& link : links) {
    if (in_tree.contains(&link)) continue;
    std::vector<const PairwiseRegistration*> around = way(tree, link.source, link.target);
    if (around.empty()) continue;
    around.insert(around.begin(), &link);
    loops.push_back(loop_along(link.target, around));
  }
  return loops;
}

bool closes(const CellLoop& loop, const LoopLimits& limits) {
  return loop.closure <= std::max(limits.least, limits.sigmas * loop.expected);
}

std::optional<Misfit> misfit_of(const Links& links, const LoopLimits& limits) {
  const std::vector<CellLoop> loops = loops_of(links);
  const auto open = [&](const CellLoop& loop) { return !closes(loop, limits); };
  const auto worst = std::ranges::max_element(
      loops, {}, [&](const CellLoop& loop) { return open(loop) ? loop.closure : -1.0; });
  if (worst == loops.end() || !open(*worst)) return std::nullopt;
  std::vector<CellId> candidates;
  for (const CellId& cell : cells_of(links)) {
    if (std::ranges::none_of(loops_of(without(links, cell)), open)) candidates.push_back(cell);
  }
  const bool several = candidates.size() != 1;
  if (candidates.empty()) candidates = worst->cells;
  const CellId cell = *std::ranges::max_element(
      candidates, {}, [&](const CellId& each) { return blame_of(loops, limits, each); });
  return Misfit{cell, !several, *worst};
}

}  // namespace chorus::site
