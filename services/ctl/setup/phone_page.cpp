#include "services/ctl/setup/phone_page.h"

#include <cctype>
#include <iostream>

#include <fmt/format.h>

namespace chorus::ctl {
namespace {

/// A token may contain any character, but in a link "+" stands for a blank, and "&" and "%" have a
/// meaning.
std::string percent_encoded(const std::string& text) {
  std::string encoded;
  for (const unsigned char c : text) {
    const bool plain = c < 128 && (std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.');
    encoded += plain ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02X}", c);
  }
  return encoded;
}

}  // namespace

bool is_loopback(const std::string& address) {
  return address.starts_with("127.") || address == "::1";
}

void tell_phone(const ServiceWishes& wishes, const std::string& url) {
  if (is_loopback(wishes.address)) {
    std::cerr << "On this computer, whose own camera it can be (a phone needs --listen 0.0.0.0):\n"
              << "  " << url << "capture/\n";
    return;
  }
  std::cerr << "On the phone, which needs ca.crt:\n  " << url << "capture/"
            << (wishes.token.empty() ? "" : "#token=" + percent_encoded(wishes.token)) << "\n";
  if (wishes.tls.empty()) {
    std::cerr << "Without a certificate no browser gives it a camera: chorus init ca and chorus "
                 "init certificate, then this again.\n";
  }
}

}  // namespace chorus::ctl
