// What a token allows.
#pragma once

namespace chorus::http {

/// Each role includes the roles before it.
enum class Role {
  Read,     ///< Reading everything except pictures and recordings.
  Images,   ///< In addition, reading pictures and recordings (Router::shows_people).
  Control,  ///< In addition, writing methods.
};

}  // namespace chorus::http
