// Parse, don't validate: JSON with // comments into a plain struct, every mistake named.
//
//   auto root = ConfigReader::parse(text, "deploy/config/fusion.json");
//   root->read("port", config.port);
//   auto quality = root->child("quality");
//   quality.read("best_distance_m", config.quality.best_distance);
//   if (auto ok = root->finish(); !ok) return pass(ok);   // unknown keys, wrong types, ranges
//
// A key that is absent leaves the default.  finish() reports every problem at once: unknown keys
// with their full path and the nearest known key, wrong types, values out of range.  Keys carry
// their unit as suffix.
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
  /// `origin` names the file in messages.  Nesting is bounded; duplicate keys are refused.
  [[nodiscard]] static Result<ConfigReader> parse(std::string_view text, std::string_view origin);

  /// Replaces one value before reading: "sensors.0.port=8082" (the --set option of every program).
  [[nodiscard]] Result<void> set(std::string_view assignment);

  void read(std::string_view key, bool& out);
  void read(std::string_view key, int& out, int least, int most);
  void read(std::string_view key, double& out, double least, double most);
  void read(std::string_view key, std::string& out);
  void read(std::string_view key, std::vector<double>& out);
  void read(std::string_view key, std::vector<std::string>& out);
  /// Key ends in _ms; the value is milliseconds.
  void read_ms(std::string_view key, Duration& out, Duration least, Duration most);
  /// Key ends in _s; the value is seconds.
  void read_s(std::string_view key, Duration& out, Duration least, Duration most);
  /// Key ends in _deg; the value is degrees, `out` radians.
  void read_deg(std::string_view key, double& out, double least_deg, double most_deg);
  /// One of `names`; `index` is left alone when the key is absent.
  void read_choice(std::string_view key, std::size_t& index,
                   const std::vector<std::string_view>& names);

  /// A nested object; absent gives an empty reader.  Children share the problem list of the root.
  [[nodiscard]] ConfigReader child(std::string_view key);
  /// The objects of an array; absent gives none.
  [[nodiscard]] std::vector<ConfigReader> items(std::string_view key);
  [[nodiscard]] bool has(std::string_view key) const;
  /// What stands at the key, set() included, as JSON without comments; "" when it is absent.
  [[nodiscard]] std::string text(std::string_view key) const;
  /// All of it.
  [[nodiscard]] std::string text() const;

  /// Adds a problem found by the caller at this key ("must be below ...").
  void complain(std::string_view key, std::string message);

  /// All problems in one Error (Malformed/InvalidArgument), or success.  Call on the root, once,
  /// last.
  [[nodiscard]] Result<void> finish() const;

  struct Node;  ///< Private: the parsed tree and the problem list.

 private:
  explicit ConfigReader(std::shared_ptr<Node> node) : node_(std::move(node)) {}
  std::shared_ptr<Node> node_;
};

}  // namespace chorus
