// A hall of several cells, simulated at the level of what the cells publish: people with stated
// errors, places of cells that are not exact, clocks that differ, messages that take time.
//
// What the sensors of a cell do is not simulated: each cell sees everybody within its rectangle,
// under an id that is new each time they enter, and never confuses two people.  The site stage of
// every cell runs as it is, with a store of claims between them.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/sensor/sensor_frame.h"
#include "fusion-server/site/site.h"

namespace chorus::bench {

/// Where somebody is at a time [s]: (x, z) [m]; none: not in the hall.
using HallPath = std::function<std::optional<Eigen::Vector2d>(double)>;

struct HallPerson {
  HallPath path;
  double size = 1.0;  ///< Relative to an adult of 1.75 m.
  /// Whether arms and legs swing as the person walks; otherwise they glide like a statue.
  bool swings = false;
  /// What each length differs by, relative (associate::kSpans).
  std::array<double, associate::kSpans> build{};
};

struct HallCell {
  site::CellId id;
  Eigen::AlignedBox2d sees;                                          ///< (x, z), site [m]
  std::vector<Eigen::AlignedBox2d> blind = {};                       ///< Behind walls.
  Eigen::Isometry3d site_from_cell = Eigen::Isometry3d::Identity();  ///< In truth.
  site::CellPlace stated;                                            ///< What the site believes.
  Duration clock_ahead{0};                                           ///< Of true time.
};

/// What a cell makes of people; standard deviations.
struct HallErrors {
  double bias = 0.025;    ///< Of a place, lasting some seconds, per axis [m].
  double noise = 0.008;   ///< Of a place, per axis [m].
  double stated = 0.025;  ///< What the cell states [m].
  double length = 0.02;   ///< Of a length, for a whole visit, relative.
  /// Of elbows, wrists, knees and ankles beside that of the place, per axis [m].  Lasts 0.35 s.
  /// Measured between four real cameras and four others: 19 mm (docs/benchmarks/site.md).
  double limb = 0.0135;
};

/// What was forged, cut or delayed; all optional.
struct HallFaults {
  std::function<bool(std::size_t from, std::size_t to, double time)> hears = {};
  std::function<bool(std::size_t cell, double time)> store = {};  ///< Whether it reaches the store.
  std::function<void(std::size_t cell, double time, site::CellPeople&)> forge = {};
  Duration delay = std::chrono::milliseconds(5);
};

/// One cell's word on one person, and who it truly is.
struct HallWord {
  std::size_t cell = 0;
  std::size_t person = 0;
  PersonId body;
  std::optional<site::SiteId> id;
  double certainty = 0.0;
  bool doubtful = false;
  site::CellId owner;
};

class Hall {
 public:
  Hall(std::vector<HallCell> cells, std::vector<HallPerson> people, std::uint64_t seed,
       HallErrors errors = {}, HallFaults faults = {});

  /// One period: all cells look, tell, hear and decide.
  void step();
  /// One period in which the cells only look.
  void look_only();
  [[nodiscard]] double time() const { return time_; }  ///< [s] since the beginning.
  [[nodiscard]] const std::vector<HallWord>& words() const { return words_; }
  [[nodiscard]] site::Site& site(std::size_t cell) { return sites_[cell]; }
  [[nodiscard]] Timestamp clock(std::size_t cell) const;
  [[nodiscard]] const std::vector<site::SiteEvent>& events(std::size_t cell) const {
    return events_[cell];
  }
  [[nodiscard]] const std::vector<HallCell>& cells() const { return cells_; }
  [[nodiscard]] const std::vector<HallPerson>& people() const { return people_; }
  /// What a cell published at this step, in its own world.
  [[nodiscard]] const site::CellPeople& told(std::size_t cell) const { return told_[cell]; }
  [[nodiscard]] bool sees(std::size_t cell, const Eigen::Vector2d& place) const;
  /// The cell forgets everything and starts again.
  void restart(std::size_t cell);
  /// The cell moves the origin of its world; every cell that hears it learns so at once.
  void move_world(std::size_t cell, const Eigen::Isometry3d& new_from_old);
  [[nodiscard]] std::size_t claims() const { return store_.size(); }
  [[nodiscard]] std::size_t contradictory_claims() const { return refused_; }

  static constexpr double kPeriod = 1.0 / 30.0;  ///< [s]

 private:
  struct Visit {
    PersonId body;
    double since = 0.0;
    std::array<double, associate::kSpans> off{};
  };
  struct Letter {
    double due = 0.0;
    std::size_t to = 0;
    site::CellPeople people;
  };
  void look(std::size_t cell);
  [[nodiscard]] site::Person seen(std::size_t cell, std::size_t person, const Visit& visit) const;
  void swing(std::size_t cell, std::size_t person, const Eigen::Vector2d& walking,
             Skeleton<WorldSpace>& body) const;
  void send(std::size_t cell);
  void deliver();
  void decide(std::size_t cell);
  void serve(std::size_t cell, const site::ClaimRequest& request);

  std::vector<HallCell> cells_;
  std::vector<HallPerson> people_;
  std::uint64_t seed_;
  HallErrors errors_;
  HallFaults faults_;
  double time_ = 0.0;
  std::vector<site::Site> sites_;
  std::vector<std::uint64_t> boots_;
  std::vector<std::uint64_t> sequences_;
  std::vector<std::uint64_t> bodies_;  ///< Ids given.
  std::vector<std::map<std::size_t, Visit>> visits_;
  std::vector<site::CellPeople> told_;
  std::vector<std::vector<std::size_t>> truth_;  ///< Who told_'s people are.
  std::vector<std::vector<site::SiteEvent>> events_;
  std::vector<HallWord> words_;
  std::deque<Letter> letters_;
  std::map<site::SiteId, site::Claim> store_;
  std::size_t refused_ = 0;
};

/// A standing body: pelvis at (x, z), facing `yaw`, with these relative lengths.
[[nodiscard]] Skeleton<WorldSpace> standing_body(
    const Eigen::Vector2d& place, double yaw, const std::array<double, associate::kSpans>& build);

}  // namespace chorus::bench
