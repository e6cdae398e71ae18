// The pipeline's thread survives exceptions from its sinks.
#include "fusion-server/server/pipeline_loop.h"

#include <condition_variable>
#include <mutex>
#include <new>

#include <gtest/gtest.h>

namespace chorus::server {
namespace {

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
  options.poll_reports = [] { return std::vector<poll::PollReport>{}; };
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

}  // namespace
}  // namespace chorus::server
