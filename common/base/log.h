// Logging: one line per event, with an event name and fields, as plain text or JSON.
//
// `log::warn("sensor lost", {{"sensor", id.str()}, {"after_ms", 1500}});`
// Events that can repeat at frame rate are logged through RateReport (rate_report.h), not directly.
#pragma once

#include <concepts>
#include <initializer_list>
#include <string>
#include <string_view>

#include "common/base/result.h"

namespace chorus::log {

enum class Level { Debug, Info, Warn, Error };
enum class Format { Text, Json };

/// The shortest decimal that reads back as the same double, or "nan", "inf", "-inf".
[[nodiscard]] std::string number_text(double value);

struct Field {
  std::string_view key;
  std::string value;
  bool bare = false;  ///< True for a number or a Boolean: unquoted in JSON.

  Field(std::string_view k, std::string_view v) : key(k), value(v) {}
  Field(std::string_view k, const std::string& v) : key(k), value(v) {}
  Field(std::string_view k, const char* v) : key(k), value(v) {}
  Field(std::string_view k, bool v) : key(k), value(v ? "true" : "false"), bare(true) {}
  template <std::integral T>
  Field(std::string_view k, T v) : key(k), value(std::to_string(v)), bare(true) {}
  template <std::floating_point T>
  Field(std::string_view k, T v) : key(k), value(number_text(static_cast<double>(v))), bare(true) {}
};
using Fields = std::initializer_list<Field>;

/// Sets the lowest level that is logged, and the format; from now on a separate thread writes the
/// lines (log_queue.h).
void configure(Level least, Format format);

/// Parses the words of the configuration and the command line: "debug", "info", "warn", "error";
/// "text", "json".
[[nodiscard]] Result<Level> parse_level(std::string_view text);
[[nodiscard]] Result<Format> parse_format(std::string_view text);

/// True if lines of this level are written.  Check this first where the fields of a frequent line
/// are costly to build.
[[nodiscard]] bool is_wanted(Level level);

void event(Level level, std::string_view name, Fields fields = {});

inline void debug(std::string_view name, Fields fields = {}) { event(Level::Debug, name, fields); }
inline void info(std::string_view name, Fields fields = {}) { event(Level::Info, name, fields); }
inline void warn(std::string_view name, Fields fields = {}) { event(Level::Warn, name, fields); }
inline void error(std::string_view name, Fields fields = {}) { event(Level::Error, name, fields); }

}  // namespace chorus::log
