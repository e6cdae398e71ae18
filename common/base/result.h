// Result<T>: a value, or the Error that says why there is none.  It stands in for std::expected,
// which needs C++23.
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

#include "common/base/error.h"

namespace chorus {

template <class T>
using Result = tl::expected<T, Error>;

/// Makes an error: `return fail(ErrorCode::NotFound, path, "there is no such frame");`
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string context,
                                                std::string message) {
  return tl::unexpected<Error>(Error{code, std::move(context), std::move(message)});
}

/// Passes an error on unchanged: `if (!x) return pass(x);`
template <class T>
[[nodiscard]] tl::unexpected<Error> pass(const Result<T>& failed) {
  return tl::unexpected<Error>(failed.error());
}

}  // namespace chorus
