#include "fusion-server/publish/osc/osc.h"

#include <bit>
#include <cmath>

namespace chorus::publish::osc {
namespace {

constexpr std::size_t kWord = 4;
constexpr std::string_view kBundle{"#bundle\0", 8};
constexpr std::uint32_t kTimeTagNow = 1;  ///< The low word of the time tag; the high one is 0.

void add_word(std::vector<char>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    out.push_back(static_cast<char>((value >> shift) & 0xFFU));
  }
}

void add_text(std::vector<char>& out, std::string_view text) {
  text = text.substr(0, text.find('\0'));
  out.insert(out.end(), text.begin(), text.end());
  out.resize(out.size() + kWord - text.size() % kWord, '\0');
}

void add_all(std::vector<char>& out, const std::vector<char>& more) {
  out.insert(out.end(), more.begin(), more.end());
}

}  // namespace

Message& Message::integer(std::int32_t value) {
  types_ += 'i';
  add_word(arguments_, static_cast<std::uint32_t>(value));
  return *this;
}

Message& Message::real(double value) {
  types_ += 'f';
  const auto narrow = static_cast<float>(value);
  add_word(arguments_, std::bit_cast<std::uint32_t>(std::isfinite(narrow) ? narrow : 0.0F));
  return *this;
}

Message& Message::text(std::string_view value) {
  types_ += 's';
  add_text(arguments_, value);
  return *this;
}

Message& Message::vector(const Eigen::Vector3d& value) {
  return real(value.x()).real(value.y()).real(value.z());
}

Message& Message::quaternion(const Eigen::Quaterniond& value) {
  return real(value.x()).real(value.y()).real(value.z()).real(value.w());
}

std::vector<char> Message::bytes() const {
  std::vector<char> out;
  add_text(out, address_);
  add_text(out, types_);
  add_all(out, arguments_);
  return out;
}

void Bundles::add(const Message& message) {
  const std::vector<char> bytes = message.bytes();
  if (bundles_.empty() || bundles_.back().size() + kWord + bytes.size() > limit_) {
    std::vector<char>& bundle = bundles_.emplace_back(kBundle.begin(), kBundle.end());
    add_word(bundle, 0);
    add_word(bundle, kTimeTagNow);
  }
  add_word(bundles_.back(), static_cast<std::uint32_t>(bytes.size()));
  add_all(bundles_.back(), bytes);
}

}  // namespace chorus::publish::osc
