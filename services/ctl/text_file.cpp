#include "services/ctl/text_file.h"

#include <fstream>
#include <iostream>

#include "common/importers/text_rows.h"

namespace chorus::ctl {
namespace {

constexpr std::uintmax_t kMaxTextBytes = 16u << 20;

}  // namespace

Result<std::string> read_text(const std::string& file) {
  return importers::read_bounded(file, kMaxTextBytes);
}

Result<void> write_text(const std::string& file, std::string_view text) {
  if (file == "-") {
    std::cout << text << std::flush;
    if (std::cout) return {};
    return fail(ErrorCode::Io, "standard output", "cannot be written.");
  }
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text;
  if (!out.flush()) return fail(ErrorCode::Io, file, "cannot be written; is its folder there?");
  return {};
}

}  // namespace chorus::ctl
