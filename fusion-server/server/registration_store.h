// The registration that survives a restart: one file, replaced atomically.
#pragma once

#include <optional>
#include <string>

#include "common/base/result.h"
#include "fusion-server/flow.h"

namespace chorus::server {

class RegistrationStore {
 public:
  /// An empty folder keeps nothing.
  explicit RegistrationStore(std::string folder) : folder_(std::move(folder)) {}

  /// The stored registration; none when there is none.  A file that cannot be read is an error and
  /// stays.
  [[nodiscard]] Result<std::optional<Registration>> load() const;

  /// Writes a temporary file, syncs it, renames it.  A failure leaves the stored one untouched.
  [[nodiscard]] Result<void> save(const Registration& registration) const;

  /// Moves the stored one aside as registration.json.old, so that forgetting by mistake can be
  /// undone.
  [[nodiscard]] Result<void> forget() const;

  [[nodiscard]] std::string path() const;

 private:
  std::string folder_;
};

/// Given extrinsics; here a missing file is an error.
[[nodiscard]] Result<Registration> load_registration_file(const std::string& path);

}  // namespace chorus::server
