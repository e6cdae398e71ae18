#include "common/base/error.h"

#include <array>

namespace chorus {
namespace {

struct Row {
  ErrorCode code;
  std::string_view name;
  int status;
};

constexpr std::array kRows{
    Row{ErrorCode::InvalidArgument, "invalid-argument", 400},
    Row{ErrorCode::Malformed, "malformed", 400},
    Row{ErrorCode::TooLarge, "too-large", 413},
    Row{ErrorCode::NotFound, "not-found", 404},
    Row{ErrorCode::Gone, "gone", 410},
    Row{ErrorCode::NotAcceptable, "not-acceptable", 406},
    Row{ErrorCode::Unsupported, "unsupported", 501},
    Row{ErrorCode::Unauthorized, "unauthorized", 401},
    Row{ErrorCode::Forbidden, "forbidden", 403},
    Row{ErrorCode::Conflict, "conflict", 409},
    Row{ErrorCode::Unavailable, "unavailable", 503},
    Row{ErrorCode::Timeout, "timeout", 504},
    Row{ErrorCode::Io, "io", 500},
    Row{ErrorCode::Internal, "internal", 500},
};

const Row& row_of(ErrorCode code) noexcept {
  for (const Row& row : kRows) {
    if (row.code == code) return row;
  }
  return kRows.back();
}

}  // namespace

std::string_view name_of(ErrorCode code) noexcept { return row_of(code).name; }

int http_status(ErrorCode code) noexcept { return row_of(code).status; }

std::string to_string(const Error& error) {
  if (error.context.empty()) return error.message;
  return error.context + ": " + error.message;
}

}  // namespace chorus
