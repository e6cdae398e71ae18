// A small program on hosts that need no more, and the whole one where its package is installed.
#pragma once

#include <string>

namespace chorus::service {

/// Becomes the program at this path, seen from the folder of this one ("../libexec/chorus/chorus");
/// returns when it is not there.
void become_whole_program(const std::string& path, char** arguments);

}  // namespace chorus::service
