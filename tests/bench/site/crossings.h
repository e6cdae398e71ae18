// How well people keep their ids when they go from cell to cell, whoever gives the ids.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace chorus::bench {

/// A cell sees a person, and the id that the person has there now.
struct SeenAs {
  std::size_t cell = 0;
  std::size_t person = 0;
  std::string id;         ///< Empty: none yet.
  bool doubtful = false;  ///< The method says that the id may be wrong.
};

/// A way into a cell of somebody who had an id.
struct CrossingCount {
  std::size_t all = 0;
  std::size_t kept = 0;          ///< The id was that from before, from the first to the last.
  std::size_t wrong = 0;         ///< At some time the id was that of somebody else.
  std::size_t wrong_unsaid = 0;  ///< ... without a doubt stated.
};

struct CrossingScore {
  CrossingCount overlap;            ///< Another cell still saw the person.
  CrossingCount gap;                ///< No cell had seen them for up to four seconds.
  double doubled_per_minute = 0.0;  ///< A person bore two ids for a second or longer.
  std::vector<double> first_id;     ///< From sight to the first id, of each visit [s].
  double doubtful_percent = 0.0;    ///< Of the time in which people had ids.
};

class Crossings {
 public:
  explicit Crossings(double period) : period_(period) {}
  /// All that is seen at one instant.
  void add(double time, const std::vector<SeenAs>& seen);
  /// Ends all visits.
  [[nodiscard]] CrossingScore score();

 private:
  struct Visit {
    double begin = 0.0;
    double last = 0.0;
    std::string before;  ///< The id with which the person came; empty: none.
    bool overlap = false;
    bool counted = false;  ///< False: the first sight ever, or after too long a time.
    std::string first;
    std::set<std::string> ids;
    std::set<std::string> unsaid;  ///< Those that were borne without a doubt stated.
  };
  struct Last {
    std::string id;
    double at = 0.0;
  };
  void begin(double time, const SeenAs& seen);
  void end(std::size_t person, const Visit& visit);
  void end_old(double time);
  void count_doubles(const std::vector<SeenAs>& seen);

  double period_;
  double begun_ = -1.0;
  double now_ = 0.0;
  std::map<std::pair<std::size_t, std::size_t>, Visit> visits_;  ///< (cell, person)
  std::map<std::size_t, Last> last_;
  std::map<std::string, std::size_t> owner_;  ///< Who bore an id first.
  std::map<std::size_t, double> doubled_for_;
  std::size_t doubles_ = 0;
  std::size_t named_ = 0;
  std::size_t doubtful_ = 0;
  CrossingScore score_;
};

}  // namespace chorus::bench
