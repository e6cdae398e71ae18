// A slow outlet costs the pipeline nothing, and the frames it misses are counted.
#include "fusion-server/outlet/outlet.h"

#include <condition_variable>
#include <mutex>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/builders.h"

namespace chorus::outlet {
namespace {

/// The frames that an outlet was given, and a gate that blocks it.
struct Log {
  std::mutex mutex;
  std::condition_variable changed;
  bool open = true;
  bool entered = false;
  std::vector<std::uint64_t> sequences;
  std::vector<Timestamp> instants;
  std::vector<std::size_t> slots;  ///< Slots of all bodies received.
};

class SlowOutlet final : public Outlet {
 public:
  explicit SlowOutlet(std::shared_ptr<Log> log) : log_(std::move(log)) {}
  [[nodiscard]] std::string_view name() const override { return "slow"; }
  void send(const TrackerFrame& frame) override {
    std::unique_lock lock(log_->mutex);
    log_->entered = true;
    log_->changed.notify_all();
    log_->changed.wait(lock, [&] { return log_->open; });
    log_->sequences.push_back(frame.sequence);
    log_->instants.push_back(frame.instant);
    for (const TrackerBody& body : frame.bodies) log_->slots.push_back(body.slot);
    log_->changed.notify_all();
  }
  [[nodiscard]] SinkCounters counters() const override { return {.failed = 3, .clients = 2}; }

 private:
  std::shared_ptr<Log> log_;
};

struct FixedClock final : Clock {
  [[nodiscard]] Timestamp now() const override {
    return testing::kStart + std::chrono::milliseconds(30);
  }
};

std::shared_ptr<const Snapshot> snapshot(std::uint64_t sequence) {
  auto s = std::make_shared<Snapshot>();
  s->sequence = sequence;
  s->instant = testing::kStart;
  return s;
}

void wait_until(Log& log, const std::function<bool()>& holds) {
  std::unique_lock lock(log.mutex);
  ASSERT_TRUE(log.changed.wait_for(lock, std::chrono::seconds(20), holds));
}

TEST(OutletSink, DropsTheOldestWhileTheOutletIsBusy) {
  auto log = std::make_shared<Log>();
  log->open = false;
  OutletSink sink(std::make_unique<SlowOutlet>(log), {});
  sink.publish(snapshot(1));
  wait_until(*log, [&] { return log->entered; });
  for (std::uint64_t i = 2; i <= 9; ++i) sink.publish(snapshot(i));
  {
    const std::scoped_lock lock(log->mutex);
    log->open = true;
  }
  log->changed.notify_all();
  wait_until(*log, [&] { return log->sequences.size() == 3; });
  EXPECT_EQ(log->sequences, (std::vector<std::uint64_t>{1, 8, 9}));
  EXPECT_EQ(sink.counters().dropped, 6u);
}

TEST(OutletSink, AddsItsCountsToThoseOfTheProtocol) {
  auto log = std::make_shared<Log>();
  OutletSink sink(std::make_unique<SlowOutlet>(log), {});
  sink.publish(snapshot(1));
  wait_until(*log, [&] { return log->sequences.size() == 1; });
  EXPECT_EQ(sink.counters().failed, 3u);
  EXPECT_EQ(sink.counters().clients, 2u);
  EXPECT_EQ(sink.name(), "slow");
}

/// Throws at every other frame.
class BrokenOutlet final : public Outlet {
 public:
  explicit BrokenOutlet(std::shared_ptr<Log> log) : log_(std::move(log)) {}
  [[nodiscard]] std::string_view name() const override { return "broken"; }
  void send(const TrackerFrame& frame) override {
    if (frame.sequence % 2 == 1) throw std::bad_alloc();
    const std::scoped_lock lock(log_->mutex);
    log_->sequences.push_back(frame.sequence);
    log_->changed.notify_all();
  }
  [[nodiscard]] SinkCounters counters() const override { return {.failed = 3}; }

 private:
  std::shared_ptr<Log> log_;
};

TEST(OutletSink, WhatAnOutletThrowsCostsThatFrameAndIsCounted) {
  auto log = std::make_shared<Log>();
  ::testing::internal::CaptureStderr();
  {
    OutletSink sink(std::make_unique<BrokenOutlet>(log), {});
    for (std::uint64_t i = 1; i <= 4; i += 2) {
      sink.publish(snapshot(i));
      sink.publish(snapshot(i + 1));
      wait_until(*log, [&] { return log->sequences.size() == (i + 1) / 2; });
    }
    EXPECT_EQ(log->sequences, (std::vector<std::uint64_t>{2, 4}));
    EXPECT_EQ(sink.counters().failed, 5u);
  }
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("output broken failed"), std::string::npos) << said;
}

TEST(OutletSink, TwoOutputsOfWhichOneMissedFramesShowTheSameSlots) {
  const auto shown = [](const std::vector<std::uint64_t>& seen) {
    auto log = std::make_shared<Log>();
    OutletSink sink(std::make_unique<SlowOutlet>(log), {});
    for (const std::uint64_t sequence : seen) {
      auto s = std::make_shared<Snapshot>(*snapshot(sequence));
      s->bodies.resize(2);
      s->bodies[0].id = {sequence};
      s->bodies[0].slot = sequence;
      sink.publish(s);
      wait_until(*log,
                 [&] { return !log->sequences.empty() && log->sequences.back() == sequence; });
    }
    return log->slots.back();
  };
  EXPECT_EQ(shown({1, 2, 3, 4}), 4u);
  EXPECT_EQ(shown({4}), 4u);
}

TEST(OutletSink, PredictsOnlyWhenAsked) {
  for (const Latency latency : {Latency::Exact, Latency::Predicted}) {
    auto log = std::make_shared<Log>();
    OutletSink sink(std::make_unique<SlowOutlet>(log),
                    {latency, 6, std::make_shared<FixedClock>()});
    sink.publish(snapshot(1));
    wait_until(*log, [&] { return log->instants.size() == 1; });
    const Duration ahead = log->instants.front() - testing::kStart;
    EXPECT_EQ(ahead,
              latency == Latency::Exact ? Duration{0} : Duration(std::chrono::milliseconds(30)));
  }
}

}  // namespace
}  // namespace chorus::outlet
