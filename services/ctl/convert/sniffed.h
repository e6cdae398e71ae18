// Errors of commands that read files, with what the files are.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/result.h"
#include "common/record/sniff.h"

namespace chorus::ctl {

/// `done`, or its error with what the first unexpected of the inputs is, and what to do with it.
[[nodiscard]] inline Result<int> sniffed(Result<int> done, const std::vector<std::string>& inputs,
                                         std::string_view expected = "recording") {
  if (done) return done;
  const std::vector<std::filesystem::path> files(inputs.begin(), inputs.end());
  return tl::unexpected<Error>(record::with_sniffed(done.error(), files, expected));
}

}  // namespace chorus::ctl
