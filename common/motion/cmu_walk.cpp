#include "common/motion/cmu_walk.h"

#include <cstdlib>

#include "cmu_assets.h"
#include "common/base/log.h"

namespace chorus::motion {
namespace {

/// The parsed value.  If a built-in file does not parse, the build is broken, so the program
/// aborts.
template <class Value>
Value built_in(Result<Value> parsed) {
  if (parsed) return *std::move(parsed);
  log::error("built-in motion is broken", {{"why", to_string(parsed.error())}});
  std::abort();
}

CmuWalk load() {
  CmuWalk walk;
  walk.skeleton = built_in(parse_asf(assets::k02_asf, "02.asf"));
  walk.takes.push_back(built_in(parse_amc(assets::k02_01_amc, "02_01.amc", walk.skeleton)));
  walk.takes.push_back(built_in(parse_amc(assets::k02_02_amc, "02_02.amc", walk.skeleton)));
  return walk;
}

}  // namespace

const CmuWalk& cmu_walk() {
  static const CmuWalk walk = load();
  return walk;
}

}  // namespace chorus::motion
