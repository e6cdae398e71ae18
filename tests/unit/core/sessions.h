// A registrar whose sessions a test walks and whose solves it answers.
#pragma once

#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "fusion-server/core/registrar.h"
#include "tests/support/builders.h"
#include "tests/unit/core/ring_of_three.h"

namespace chorus::core {

[[nodiscard]] inline RegistrarConfig registrar_config() { return of_three<RegistrarConfig>(); }

[[nodiscard]] inline Registration refused(
    const std::string& reason = "sensors s1 and s2 disagree") {
  Registration r;
  r.verdict = Verdict::Refused;
  r.reasons = {reason};
  for (int i = 0; i < kSensors; ++i)
    r.verdicts[testing::sensor_id(name(i))] = {Verdict::Refused, {reason}};
  return r;
}

class Sessions : public ::testing::Test {
 protected:
  void begin_with(Registration registration, std::uint64_t first = 7) {
    registrar_.emplace(registrar_config(), std::move(registration), first);
  }
  Registrar& registrar() { return *registrar_; }

  /// All sensors see one person for `length`; returns the first job that becomes due.
  std::optional<SolveJob> walk(Duration length, int sensors = kSensors) {
    for (const Timestamp end = now_ + length; now_ < end; now_ += std::chrono::milliseconds(33)) {
      for (int i = 0; i < sensors; ++i) {
        SensorFrame frame = testing::sensor_frame(name(i), now_, {BodyFrame{}});
        frame.received = now_;
        registrar().take(frame);
      }
      if (auto job = registrar().due_job(now_)) return job;
    }
    return std::nullopt;
  }
  Outcome answer(const SolveJob& job, Registration registration) {
    return registrar().solved({job.session, job.kind, std::move(registration)}, now_);
  }
  SessionStatus newest() { return registrar().sessions().front(); }

  std::optional<Registrar> registrar_;
  Timestamp now_ = testing::kStart;
};

}  // namespace chorus::core
