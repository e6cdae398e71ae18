// What survives a restart: the registration and how far the ids of people have come, a file each,
// replaced atomically.
#pragma once

#include <cstdint>
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

  /// The first id of a person that no earlier run may have given; 1 when none is known.
  [[nodiscard]] Result<std::uint64_t> load_next_person() const;
  [[nodiscard]] Result<void> save_next_person(std::uint64_t next) const;

  [[nodiscard]] std::string path() const;
  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  [[nodiscard]] std::string people_path() const;
  [[nodiscard]] Result<void> write(const std::string& file, const std::string& text) const;

  std::string folder_;
};

/// Given extrinsics; here a missing file is an error.
[[nodiscard]] Result<Registration> load_registration_file(const std::string& path);

}  // namespace chorus::server
