#include "common/http/page_lines.h"

#include <openssl/evp.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <string>

#include "common/http/text.h"

namespace chorus::http {
namespace {

struct PageRow {
  std::string_view may_load;  ///< Of its Content-Security-Policy, after default-src 'none'.
  std::string_view others;    ///< Further header lines.
};

constexpr std::string_view kNoCamera =
    "Permissions-Policy: camera=(), microphone=(), geolocation=()\r\n";

// In the order of Page.
constexpr std::array kPages{
    // Its styles are in it.
    PageRow{"style-src 'unsafe-inline'; img-src data:", kNoCamera},
    PageRow{"script-src 'self'; connect-src 'self'; style-src 'self'; img-src 'self' data: blob:",
            kNoCamera},
    // 'wasm-unsafe-eval' is needed to compile WebAssembly.
    PageRow{"script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; "
            "style-src 'self'; img-src 'self' data:; media-src 'self' blob:",
            "Permissions-Policy: camera=(self), microphone=(), geolocation=()\r\n"
            "Cross-Origin-Opener-Policy: same-origin\r\n"},
};

constexpr std::string_view kOwnScripts = "script-src 'self'";

/// The same, and the script with this text.
std::string and_script(std::string_view own, std::string_view script) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  SHA256(reinterpret_cast<const unsigned char*>(script.data()), script.size(), digest.data());
  std::array<unsigned char, 4 * ((SHA256_DIGEST_LENGTH + 2) / 3) + 1> text{};
  EVP_EncodeBlock(text.data(), digest.data(), static_cast<int>(digest.size()));
  std::string out(own);
  out.append(" 'sha256-").append(reinterpret_cast<const char*>(text.data())).append("'");
  return out;
}

}  // namespace

/// X-Frame-Options says the same as frame-ancestors, to browsers from before 2017.
std::string page_lines(Page page, std::string_view import_map) {
  const PageRow& row = kPages[static_cast<std::size_t>(page)];
  std::string may_load(row.may_load);
  const std::size_t scripts = may_load.find(kOwnScripts);
  if (!import_map.empty() && scripts != std::string::npos)
    may_load.replace(scripts, kOwnScripts.size(), and_script(kOwnScripts, import_map));
  std::string lines = "Content-Security-Policy: default-src 'none'; ";
  lines.append(may_load)
      .append(
          "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
          "X-Frame-Options: DENY\r\n"
          "Referrer-Policy: no-referrer\r\n")
      .append(row.others);
  return lines;
}

std::string_view import_map_of(std::string_view html) {
  constexpr std::string_view kBegin = "<script type=\"importmap\">";
  const std::size_t begin = html.find(kBegin);
  if (begin == std::string_view::npos) return {};
  html.remove_prefix(begin + kBegin.size());
  const std::size_t end = html.find("</script>");
  return end == std::string_view::npos ? std::string_view() : html.substr(0, end);
}

bool is_page(std::string_view media_type) {
  constexpr std::array<std::string_view, 3> kPageTypes{"text/html", "application/xhtml+xml",
                                                       "image/svg+xml"};
  const std::string_view type = media_type.substr(0, media_type.find(';'));
  return std::ranges::any_of(kPageTypes, [&](auto one) { return equal_ignoring_case(one, type); });
}

}  // namespace chorus::http
