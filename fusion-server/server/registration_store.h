// Keeps three things across restarts: the registration, the one before it, and up to which number
// person ids may have been used. Each has a file, which is replaced atomically.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/base/result.h"
#include "fusion-server/flow/registration.h"

namespace chorus::server {

struct Recovered {
  std::optional<Registration> registration;
  std::string told;  ///< What was wrong and what became of the files, as a sentence for people.
};

class RegistrationStore {
 public:
  /// If the folder is empty, nothing is stored.
  explicit RegistrationStore(std::string folder) : folder_(std::move(folder)) {}

  /// Loads the stored registration; none if nothing is stored.  An unreadable file is an error, and
  /// is left as it is.
  [[nodiscard]] Result<std::optional<Registration>> load() const;

  /// What a start makes of a stored file that cannot be read (`damage`): moves it aside to
  /// registration.json.damaged, and puts the registration before it, if there is one that can be
  /// read, in its place.
  [[nodiscard]] Recovered recover(const Error& damage) const;

  /// The registration before the stored one, for an undo; none if no earlier one can be read.
  [[nodiscard]] std::optional<Registration> load_earlier() const;

  /// Writes a temporary file, syncs it, renames it.  On failure the stored file is unchanged.
  /// `earlier` goes to registration.json.old in the same way.
  [[nodiscard]] Result<void> save(const Registration& registration,
                                  const std::optional<Registration>& earlier = {}) const;

  /// Moves the stored file to registration.json.old, so that the user can undo it.
  [[nodiscard]] Result<void> forget() const;

  /// The lowest person id that no earlier run can have used; 1 if nothing is stored.
  [[nodiscard]] Result<std::uint64_t> load_next_person() const;
  [[nodiscard]] Result<void> save_next_person(std::uint64_t next) const;

  [[nodiscard]] std::string path() const;
  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }

 private:
  [[nodiscard]] std::string people_path() const;
  [[nodiscard]] Result<void> write(const std::string& file, const std::string& text) const;

  std::string folder_;
};

/// Loads given extrinsics; a missing file is an error.
[[nodiscard]] Result<Registration> load_registration_file(const std::string& path);

}  // namespace chorus::server
