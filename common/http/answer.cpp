#include "common/http/answer.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>

#include "common/http/status.h"

namespace chorus::http {
namespace {

struct ReasonRow {
  int status;
  std::string_view phrase;
};

constexpr std::array kReasons{
    ReasonRow{status::kOk, "OK"},
    ReasonRow{status::kCreated, "Created"},
    ReasonRow{status::kAccepted, "Accepted"},
    ReasonRow{status::kNoContent, "No Content"},
    ReasonRow{status::kNotModified, "Not Modified"},
    ReasonRow{status::kPermanentRedirect, "Permanent Redirect"},
    ReasonRow{status::kBadRequest, "Bad Request"},
    ReasonRow{status::kUnauthorized, "Unauthorized"},
    ReasonRow{status::kForbidden, "Forbidden"},
    ReasonRow{status::kNotFound, "Not Found"},
    ReasonRow{status::kMethodNotAllowed, "Method Not Allowed"},
    ReasonRow{status::kNotAcceptable, "Not Acceptable"},
    ReasonRow{status::kRequestTimeout, "Request Timeout"},
    ReasonRow{status::kConflict, "Conflict"},
    ReasonRow{status::kGone, "Gone"},
    ReasonRow{status::kLengthRequired, "Length Required"},
    ReasonRow{status::kContentTooLarge, "Content Too Large"},
    ReasonRow{status::kUriTooLong, "URI Too Long"},
    ReasonRow{status::kExpectationFailed, "Expectation Failed"},
    ReasonRow{status::kMisdirected, "Misdirected Request"},
    ReasonRow{status::kTooManyRequests, "Too Many Requests"},
    ReasonRow{status::kFieldsTooLarge, "Request Header Fields Too Large"},
    ReasonRow{status::kInternal, "Internal Server Error"},
    ReasonRow{status::kNotImplemented, "Not Implemented"},
    ReasonRow{status::kUnavailable, "Service Unavailable"},
    ReasonRow{status::kGatewayTimeout, "Gateway Timeout"},
    ReasonRow{status::kVersionNotSupported, "HTTP Version Not Supported"},
};

void append_number(std::string& out, std::int64_t value) {
  std::array<char, 24> digits{};  // 20 digits and a sign
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  out.append(digits.data(), end);
}

/// The Date field's value.  It changes only once a second, so it is formatted only that often.
const std::string& date_of(Timestamp t) {
  thread_local std::int64_t second = -1;
  thread_local std::string text;
  const auto now = std::chrono::floor<std::chrono::seconds>(t.time_since_epoch()).count();
  if (now != second) {
    second = now;
    text = http_date(t);
  }
  return text;
}

void append_clock(std::string& out, const AnswerStamp& stamp) {
  out.append(stamp.clock_field).append(": ");
  append_number(out, to_unix_ns(stamp.received));
  out.append(" ");
  append_number(out, to_unix_ns(stamp.sent));
  out.append("\r\n");
}

/// Appends milliseconds with three decimals; 0 if the capture clock is ahead of ours.
void append_age(std::string& out, Duration age) {
  const auto us =
      std::max<std::int64_t>(0, std::chrono::duration_cast<std::chrono::microseconds>(age).count());
  constexpr std::int64_t kUsPerMs = 1000;
  const std::string fraction = std::to_string(kUsPerMs + us % kUsPerMs);
  append_number(out, us / kUsPerMs);
  out.append(".").append(fraction, 1);
}

}  // namespace

std::string_view reason_phrase(int status) noexcept {
  const auto row = std::find_if(kReasons.begin(), kReasons.end(),
                                [&](const ReasonRow& r) { return r.status == status; });
  return row == kReasons.end() ? "Status" : row->phrase;
}

std::string http_date(Timestamp t) {
  constexpr std::array kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                               "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  using std::chrono::floor;
  const std::chrono::sys_time<Duration> instant{t.time_since_epoch()};
  const auto day = floor<std::chrono::days>(instant);
  const std::chrono::year_month_day date{day};
  const std::chrono::hh_mm_ss time{floor<std::chrono::seconds>(instant - day)};
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%s, %02u %s %04d %02d:%02d:%02d GMT",
                kDays[std::chrono::weekday{day}.c_encoding()], unsigned{date.day()},
                kMonths[unsigned{date.month()} - 1], int{date.year()},
                static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                static_cast<int>(time.seconds().count()));
  return text.data();
}

void write_first_lines(std::string& out, const Answer& answer, const AnswerStamp& stamp) {
  out.append("HTTP/1.1 ");
  append_number(out, answer.status);
  out.append(" ").append(reason_phrase(answer.status)).append("\r\n");
  if (!stamp.clock_field.empty()) append_clock(out, stamp);
  out.append("Date: ").append(date_of(stamp.sent)).append("\r\n");
  if (stamp.close) out.append("Connection: close\r\n");
  if (stamp.keep_alive_http10) out.append("Connection: keep-alive\r\n");
  if (answer.captured) {
    out.append("Server-Timing: age;dur=");
    append_age(out, stamp.sent - *answer.captured);
    out.append("\r\n");
  }
  out.append(answer.extra);
}

}  // namespace chorus::http
