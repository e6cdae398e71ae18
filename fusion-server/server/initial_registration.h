// The registration that a server begins with: the given one, the stored one, or none.
#pragma once

#include <string>

#include "common/base/result.h"
#include "fusion-server/server/fusion_settings.h"
#include "fusion-server/server/registration_store.h"

namespace chorus::server {

struct InitialRegistration {
  Registration registration;
  std::string damage;  ///< As StorageStatus::damage.
};

/// A given file that cannot be read is an error.  A stored one is kept aside, and the one before it
/// is used (RegistrationStore::recover).  Logs what it finds.
[[nodiscard]] Result<InitialRegistration> initial_registration(const FusionSettings& settings,
                                                               const RegistrationStore& store);

/// The given extrinsics; the error names the key registration.file.
[[nodiscard]] Result<Registration> given_registration(const std::string& file);

}  // namespace chorus::server
