#include "common/resource/template_text.h"

#include <algorithm>

#include "common/resource/frame_parts.h"
#include "common/sensor/limits.h"

namespace chorus::resource {
namespace {

constexpr std::size_t kIsoLength = 30;   // 2026-11-21T07:30:00.250000000Z
constexpr std::size_t kMaxFolder = 160;  // The longest folder in a document's IRIs.
constexpr int kMaxDigits = 15;           // A double represents these exactly.
constexpr std::array kTens{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                           1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '_' || c == '-';
}

}  // namespace

bool TemplateText::shares(std::string_view comma, std::string_view close, const ShareList& list,
                          JointResource& joint) {
  ShareList::Values values;
  std::size_t count = 0;
  do {
    if (count == values.size() || !decimal<kShareDecimals>(values[count++])) return false;
  } while (text(comma));
  const auto read = list.read(std::span<const double>(values).first(count), joint.contributors);
  if (!read || !text(close)) return false;
  joint.shares = *read;
  return true;
}

bool TemplateText::decimal(double& out) {
  const bool negative = at_ < end_ && *at_ == '-';
  if (negative) ++at_;
  const char* const begin = at_;
  std::int64_t digits = 0;
  while (at_ < end_ && is_digit(*at_) && at_ - begin <= kMaxDigits) {
    digits = digits * 10 + (*at_++ - '0');
  }
  const auto whole = at_ - begin;
  if (whole == 0 || (*begin == '0' && whole > 1) || at_ == end_ || *at_ != '.') return false;
  const char* const point = at_++;
  while (at_ < end_ && is_digit(*at_) && at_ - point <= kMaxDigits) {
    digits = digits * 10 + (*at_++ - '0');
  }
  const auto decimals = at_ - point - 1;
  if (decimals == 0 || whole + decimals > kMaxDigits) return false;
  const double value = static_cast<double>(digits) / kTens[static_cast<std::size_t>(decimals)];
  out = negative ? -value : value;
  return value <= kMaxCoordinate;
}

bool TemplateText::name(std::string_view& out) {
  if (!text("\"")) return false;
  const char* const begin = at_;
  while (at_ < end_ && plain(*at_)) ++at_;
  out = {begin, static_cast<std::size_t>(at_ - begin)};
  return text("\"") && SensorId::parse(out).has_value();
}

bool TemplateText::word(std::string_view& out) {
  constexpr std::ptrdiff_t kLongest = 32;
  const char* const begin = at_;
  while (at_ < end_ && at_ - begin < kLongest && plain(*at_)) ++at_;
  out = {begin, static_cast<std::size_t>(at_ - begin)};
  return !out.empty();
}

bool TemplateText::folder(std::string_view close, std::string_view& out) {
  const std::size_t length = rest().substr(0, kMaxFolder).find(close);
  if (length == std::string_view::npos) return false;
  out = rest().substr(0, length);
  for (const char c : out) {
    if (!plain(c) && c != '.' && c != '/') return false;
  }
  at_ += length + close.size();
  return true;
}

bool TemplateText::times(std::string_view between, Timestamp& out) {
  if (static_cast<std::size_t>(end_ - at_) < kIsoLength) return false;
  const std::string_view iso(at_, kIsoLength);
  at_ += kIsoLength;
  std::int64_t ns = 0;
  if (!text(between) || !integer(ns)) return false;
  out = from_unix_ns(ns);
  if (iso == iso_ && out == iso_time_) return true;
  const auto parsed = parse_iso8601(iso);
  if (!parsed || *parsed != out) return false;
  iso_ = iso;
  iso_time_ = out;
  return true;
}

bool TemplateText::names(std::string_view comma, std::vector<std::string>& out) {
  do {
    std::string_view one;
    if (!name(one) || out.size() == kMaxSensors) return false;
    if (std::ranges::find(out, one) != out.end()) return false;
    out.emplace_back(one);
  } while (text(comma));
  return true;
}

bool TemplateText::subset(const std::vector<std::string>& names, std::string_view comma,
                          std::uint64_t& bits) {
  const auto closes = [this](const std::string& name) {
    return rest().starts_with(name) && rest().substr(name.size()).starts_with('"');
  };
  std::size_t i = 0;  // The search goes on behind the last name, because they are in order.
  do {
    if (!text("\"")) return false;
    std::size_t left = names.size();
    for (; left > 0; --left, ++i) {
      if (i == names.size()) i = 0;
      if (closes(names[i])) break;
    }
    if (left == 0) return false;
    at_ += names[i].size() + 1;
    bits |= std::uint64_t{1} << i++;
  } while (text(comma));
  return true;
}

}  // namespace chorus::resource
