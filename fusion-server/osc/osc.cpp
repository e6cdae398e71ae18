#include "fusion-server/osc/osc.h"

#include <bit>
#include <cmath>

#include "fusion-server/outlet/big_endian.h"

namespace chorus::osc {
namespace {

constexpr std::size_t kWord = 4;
constexpr std::string_view kBundle{"#bundle\0", 8};
constexpr std::uint64_t kTimeTagNow = 1;  ///< In OSC 1.0: immediately.

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
  outlet::append_big_endian(arguments_, static_cast<std::uint32_t>(value));
  return *this;
}

Message& Message::real(double value) {
  types_ += 'f';
  const auto narrow = static_cast<float>(value);
  outlet::append_big_endian(arguments_,
                            std::bit_cast<std::uint32_t>(std::isfinite(narrow) ? narrow : 0.0F));
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
    outlet::append_big_endian(bundle, kTimeTagNow);
  }
  outlet::append_big_endian(bundles_.back(), static_cast<std::uint32_t>(bytes.size()));
  add_all(bundles_.back(), bytes);
}

}  // namespace chorus::osc
