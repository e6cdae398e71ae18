// Where the files lie that benchmarks read: deploy/config, tests/data.
#pragma once

#include <filesystem>
#include <optional>

namespace chorus::bench {

/// The first of `here`, `program` and the folders above `program` that holds deploy/config; a
/// program in build/NAME/bin finds the project that it was built from.
[[nodiscard]] std::optional<std::filesystem::path> project_folder(
    const std::filesystem::path& here, const std::filesystem::path& program);

/// Makes the project's folder the working folder, if we are not in one; says so if there is none.
void enter_project_folder();

}  // namespace chorus::bench
