// Which props there are and who holds them, and where they are while frames come.
//
// One board is shared by everybody who takes props up, puts them down and sends them; each who
// sends them has HeldProps of their own.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/workplace/held_prop.h"

namespace chorus::workplace {

struct Holding {
  std::optional<std::uint64_t> person;  ///< None: nobody holds it.
  std::uint64_t change = 0;             ///< Grows with every taking up and putting down.
};

/// Thread-safe.
class PropBoard {
 public:
  explicit PropBoard(std::vector<Prop> props = {})
      : props_(std::move(props)), holdings_(props_.size()) {}

  [[nodiscard]] const std::vector<Prop>& props() const { return props_; }
  [[nodiscard]] std::vector<Holding> holdings() const;

  /// NotFound names the props that there are.
  [[nodiscard]] Result<void> take_up(std::string_view prop, std::uint64_t person);
  [[nodiscard]] Result<void> put_down(std::string_view prop);
  [[nodiscard]] Result<std::size_t> index_of(std::string_view prop) const;

 private:
  const std::vector<Prop> props_;
  mutable std::mutex mutex_;
  std::vector<Holding> holdings_;  ///< Guarded by mutex_.
};

/// A person whom a frame shows.
struct Holder {
  std::uint64_t person = 0;
  const Skeleton<WorldSpace>* body = nullptr;
};

struct PropAt {
  Holding holding;
  /// Where it is, or where it was put down or last seen; none: it was never anywhere.
  std::optional<PropPose> pose;
  bool tracked = false;  ///< Somebody who is seen holds it: `pose` is of this instant.
};

class HeldProps {
 public:
  explicit HeldProps(std::shared_ptr<const PropBoard> board);

  /// All props of the board, in its order.
  [[nodiscard]] std::vector<PropAt> follow(Timestamp at, const std::vector<Holder>& people);

 private:
  std::shared_ptr<const PropBoard> board_;
  std::vector<PropAt> props_;
  std::vector<HeldProp> held_;
};

}  // namespace chorus::workplace
