// What the cases with four real cameras share.
#pragma once

#include "fusion-server/registration/registration.h"
#include "tests/bench/camera/camera_cases.h"

namespace chorus::bench {

/// A folder for the answers of runners; it is removed together with this object.
class Answers {
 public:
  Answers();
  ~Answers();
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  /// The runner that comes with Chorus, except that it stores its answers to the pictures of this
  /// camera and gives a stored answer at once when a picture comes again (recalling_runner.mjs).
  [[nodiscard]] std::vector<std::string> runner_of(const std::string& model,
                                                   const std::string& camera) const;

 private:
  std::string folder_;
};

/// What a model finds in every picture of the four videos, however long that takes.
[[nodiscard]] Result<std::vector<registration::WalkTrack>> looked_at(
    const std::string& model, const importers::ImportedSet& set, const Answers& answers);

/// Fuses with published places and the configuration as shipped.
[[nodiscard]] Result<Agreement> fused(const std::vector<registration::WalkTrack>& tracks,
                                      const importers::ImportedSet& set);

/// Measures how accurately one camera places people if their shape is given.
[[nodiscard]] Result<void> placed_people(Report& report);

}  // namespace chorus::bench
