// Reads JSON with // comments into a plain struct and reports every mistake.
//
//   auto root = ConfigReader::parse(text, "deploy/config/fusion.json");
//   root->read("port", config.port, 0, 65535);
//   auto quality = root->child("quality");
//   quality.read("best_distance_m", config.quality.best_distance, 0.5, 8.0);
//   if (auto ok = root->finish(); !ok) return pass(ok);   // unknown keys, wrong types, ranges
//
// An absent key leaves the default unchanged.  finish() reports all problems at once: unknown keys
// with their full path and the nearest known key, wrong types, values out of range.  The key of a
// quantity ends in its unit ("best_distance_m").
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/duration.h"
#include "common/base/result.h"

namespace chorus {

class ConfigReader {
 public:
  /// `origin` names the file in messages.  Nesting deeper than a limit and duplicate keys are
  /// refused.
  [[nodiscard]] static Result<ConfigReader> parse(std::string_view text, std::string_view origin);

  /// Replaces one value, as in "sensors.0.port=8082" (the option --set of every program).  Call
  /// this before the value is read.
  [[nodiscard]] Result<void> set(std::string_view assignment);

  void read(std::string_view key, bool& out);
  void read(std::string_view key, int& out, int least, int most);
  void read(std::string_view key, double& out, double least, double most);
  void read(std::string_view key, std::string& out);
  void read(std::string_view key, std::vector<double>& out);
  void read(std::string_view key, std::vector<std::string>& out);
  /// The key ends in _ms; the value is in milliseconds.
  void read_ms(std::string_view key, Duration& out, Duration least, Duration most);
  /// The key ends in _s; the value is in seconds.
  void read_s(std::string_view key, Duration& out, Duration least, Duration most);
  /// The key ends in _deg; the value is in degrees, `out` in radians.
  void read_deg(std::string_view key, double& out, double least_deg, double most_deg);
  /// Sets `index` to the position of the value in `names`; an absent key leaves `index` unchanged.
  void read_choice(std::string_view key, std::size_t& index,
                   const std::vector<std::string_view>& names);

  /// A nested object, empty when it is absent.  Children share the root's list of problems.
  [[nodiscard]] ConfigReader child(std::string_view key);
  /// The objects of an array; none when it is absent.
  [[nodiscard]] std::vector<ConfigReader> items(std::string_view key);
  [[nodiscard]] bool has(std::string_view key) const;
  /// The value at the key, as JSON without comments and as changed by set(); "" when it is absent.
  [[nodiscard]] std::string text(std::string_view key) const;
  /// The whole object, in the same form.
  [[nodiscard]] std::string text() const;

  /// Adds a problem that the caller found with the value of this key ("must be below ...").
  void complain(std::string_view key, std::string message);

  /// All problems in one InvalidArgument error, or success.  Call it on the root, once, after
  /// everything has been read.
  [[nodiscard]] Result<void> finish() const;

  struct Node;  ///< Private: the parsed tree and the problem list.

 private:
  explicit ConfigReader(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

}  // namespace chorus
