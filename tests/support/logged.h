// What code prints to standard error through the log, whatever other tests did to the log before.
#pragma once

#include <chrono>
#include <string>

#include <gtest/gtest.h>

#include "common/base/log.h"
#include "common/base/log_queue.h"

namespace chorus::testing {

/// What `write` prints to standard error when the log has this level and format.  Waits for the
/// log's thread before and after, because that thread writes whenever it gets to it.
template <class Write>
std::string logged(log::Level least, log::Format format, const Write& write) {
  constexpr auto kPatience = std::chrono::seconds(10);
  log::configure(least, format);
  log::flush(kPatience);
  ::testing::internal::CaptureStderr();
  write();
  log::flush(kPatience);
  return ::testing::internal::GetCapturedStderr();
}

template <class Write>
std::string logged(const Write& write) {
  return logged(log::Level::Info, log::Format::Text, write);
}

}  // namespace chorus::testing
