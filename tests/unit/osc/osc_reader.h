// Reads OSC 1.0, written from the specification and not from our writer.
#pragma once

#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace chorus::outlet::testing {

struct OscMessage {
  std::string address;
  std::string types;  ///< Type tags without the comma.
  std::vector<double> numbers;
  std::vector<std::string> texts;
};

/// Throws on anything the specification does not allow.
class OscReader {
 public:
  explicit OscReader(const std::vector<char>& bytes)
      : OscReader(std::string_view(bytes.data(), bytes.size())) {}
  explicit OscReader(std::string_view bytes) : rest_(bytes) {
    if (rest_.size() % 4 != 0) throw std::runtime_error("size");
  }

  /// All messages in a packet: a single one, or those of a bundle.
  std::vector<OscMessage> packet() {
    if (!rest_.starts_with("#bundle")) return {message()};
    if (text() != "#bundle" || word() != 0 || word() != 1) throw std::runtime_error("bundle");
    std::vector<OscMessage> all;
    while (!rest_.empty()) {
      const std::size_t size = word();
      OscReader inner(take(size));
      all.push_back(inner.message());
      if (!inner.rest_.empty()) throw std::runtime_error("size of element");
    }
    return all;
  }

 private:
  std::string_view take(std::size_t size) {
    if (size > rest_.size()) throw std::runtime_error("short");
    const std::string_view part = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return part;
  }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (const char c : take(4)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
  }
  std::string text() {
    const std::size_t length = rest_.find('\0');
    if (length == std::string_view::npos) throw std::runtime_error("no NUL");
    const std::string value(take(length));
    for (const char c : take(4 - length % 4)) {
      if (c != '\0') throw std::runtime_error("padding");
    }
    return value;
  }
  OscMessage message() {
    OscMessage m;
    m.address = text();
    const std::string types = text();
    if (m.address.empty() || m.address[0] != '/' || types.empty() || types[0] != ',') {
      throw std::runtime_error("message");
    }
    m.types = types.substr(1);
    for (const char type : m.types) argument(type, m);
    return m;
  }
  void argument(char type, OscMessage& m) {
    if (type == 's') {
      m.texts.push_back(text());
    } else if (type == 'i') {
      m.numbers.push_back(static_cast<std::int32_t>(word()));
    } else if (type == 'f') {
      const std::uint32_t bits = word();
      float value = 0;
      std::memcpy(&value, &bits, 4);
      m.numbers.push_back(static_cast<double>(value));
    } else {
      throw std::runtime_error("type");
    }
  }

  std::string_view rest_;
};

inline std::vector<OscMessage> read_osc(const std::vector<std::vector<char>>& datagrams) {
  std::vector<OscMessage> all;
  for (const auto& datagram : datagrams) {
    for (OscMessage& message : OscReader(datagram).packet()) all.push_back(std::move(message));
  }
  return all;
}

}  // namespace chorus::outlet::testing
