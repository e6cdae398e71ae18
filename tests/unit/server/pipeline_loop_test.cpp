// The pipeline's thread survives exceptions from its sinks, and says what is wrong with sensors.
#include "fusion-server/server/pipeline_loop.h"

#include <condition_variable>
#include <future>
#include <mutex>
#include <new>
#include <utility>

#include <gmock/gmock.h>

#include "tests/support/builders.h"

namespace chorus::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Throws at the first snapshot and accepts the others.
class BrokenSink final : public Sink {
 public:
  [[nodiscard]] std::string_view name() const override { return "broken"; }
  void publish(std::shared_ptr<const Snapshot> /*snapshot*/) override {
    const std::scoped_lock lock(mutex_);
    ++came_;
    if (came_ == 1) throw std::bad_alloc();
    arrived_.notify_all();
  }
  bool wait_for(int count) {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, std::chrono::seconds(20), [&] { return came_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable arrived_;
  int came_ = 0;
};

TEST(PipelineLoop, GoesOnAfterASinkHasThrownAndCountsIt) {
  ::testing::internal::CaptureStderr();
  BrokenSink sink;
  std::mutex mutex;
  Counters counters;
  LoopOptions options;
  options.clock = std::make_shared<SystemClock>();
  options.sinks.push_back(&sink);
  options.on_amended = [](const Snapshot&) {};
  options.poll_reports = [] { return std::vector<client::FollowReport>{}; };
  options.on_status = [&](const Status& status) {
    const std::scoped_lock lock(mutex);
    counters = status.counters;
  };
  {
    PipelineLoop loop(std::move(options));
    loop.start();
    EXPECT_TRUE(sink.wait_for(20));  // enough snapshots for a report of the status
  }
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("pipeline step failed"), std::string::npos) << said;
  EXPECT_EQ(counters.steps_failed, 1u);
  EXPECT_GT(counters.step_seconds, 0.0);
  EXPECT_EQ(counters.jobs_failed, 0u);
}

/// What is said of a connected sensor whose newest frame is 5.936 s old.
std::string said_of_old_frames(double rate_hz, const std::optional<ClockEstimate>& offset) {
  std::promise<std::string> said;
  bool done = false;
  LoopOptions options;
  options.clock = std::make_shared<SystemClock>();
  options.poll_reports = [&, clock = options.clock] {
    client::FollowReport report;
    report.service.id = chorus::testing::sensor_id("cam1");
    report.state = client::SensorState::Live;
    report.newest = clock->now() - std::chrono::milliseconds(5936);
    report.rate_hz = rate_hz;
    report.clock = offset;
    return std::vector<client::FollowReport>{report};
  };
  options.on_status = [&](const Status& status) {
    if (!std::exchange(done, true)) said.set_value(status.sensors.at(0).last_error);
  };
  PipelineLoop loop(std::move(options));
  loop.start();
  return said.get_future().get();
}

TEST(PipelineLoop, OldFramesOfASlowDeviceAreToldFromNone) {
  const std::string slow = said_of_old_frames(0.5, {});
  EXPECT_THAT(slow, HasSubstr("its frames come, but late: the newest was captured 5.9 s ago"));
  EXPECT_THAT(slow, HasSubstr("GET /camera there"));
  EXPECT_THAT(slow, HasSubstr("the clock of its host"));
  EXPECT_THAT(said_of_old_frames(0.0, {}), HasSubstr("no frame comes at present"));
  EXPECT_THAT(said_of_old_frames(0.5, ClockEstimate{}), Not(HasSubstr("clock")))
      << "that host tells its time";
}

}  // namespace
}  // namespace chorus::server
