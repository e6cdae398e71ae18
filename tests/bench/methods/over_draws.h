// Runs independent draws on all cores.  The results are returned in the order of the draws, so they
// do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <optional>
#include <thread>
#include <type_traits>
#include <vector>

namespace chorus::bench {

/// Returns each(0), ..., each(count - 1).  `each` must be safe to call from several threads.
template <class Each>
[[nodiscard]] auto over_draws(std::size_t count, const Each& each) {
  using Value = std::invoke_result_t<Each, std::size_t>;
  std::vector<std::optional<Value>> found(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) found[i].emplace(each(i));
  };
  const std::size_t threads = std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1,
                                                      std::max<std::size_t>(1, count));
  std::vector<std::future<void>> others;
  for (std::size_t i = 1; i < threads; ++i) others.push_back(std::async(std::launch::async, work));
  work();
  for (std::future<void>& other : others) other.get();
  std::vector<Value> values;
  values.reserve(count);
  for (std::optional<Value>& value : found) values.push_back(*std::move(value));
  return values;
}

}  // namespace chorus::bench
