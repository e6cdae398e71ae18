// The thread for slow jobs survives jobs that throw.
#include "fusion-server/server/worker.h"

#include <future>
#include <new>

#include <gtest/gtest.h>

namespace chorus::server {
namespace {

TEST(Worker, GoesOnAfterAJobHasThrownAndCountsIt) {
  ::testing::internal::CaptureStderr();
  Worker worker;
  std::promise<void> done;
  worker.post([] { throw std::bad_alloc(); });
  worker.post([&done] { done.set_value(); });
  const auto waited = done.get_future().wait_for(std::chrono::seconds(20));
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(waited, std::future_status::ready);
  EXPECT_EQ(worker.failed(), 1u);
  EXPECT_NE(said.find("background job failed what="), std::string::npos) << said;
}

}  // namespace
}  // namespace chorus::server
