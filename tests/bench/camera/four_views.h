// What the cases with four real cameras share.
#pragma once

#include "fusion-server/registration/registration.h"
#include "tests/bench/camera/camera_cases.h"

namespace chorus::bench {

/// A folder for the answers of runners; gone with the object.
class Answers {
 public:
  Answers();
  ~Answers();
  Answers(const Answers&) = delete;
  Answers& operator=(const Answers&) = delete;

  /// The same runner, which keeps its answers to the pictures of this camera and gives them at once
  /// when they come again (recalling_runner.mjs).
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

/// Measures how far away a camera places people whose shape is told.
[[nodiscard]] Result<void> placed_people(Report& report);

}  // namespace chorus::bench
