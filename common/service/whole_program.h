// Lets the small program, which every host has, run the whole program instead where that one's
// package is installed.
#pragma once

#include <string>

namespace chorus::service {

/// Replaces this process by the program at `path`, relative to this program's folder
/// ("../libexec/chorus/chorus"); returns when that cannot be run.
void become_whole_program(const std::string& path, char** arguments);

}  // namespace chorus::service
