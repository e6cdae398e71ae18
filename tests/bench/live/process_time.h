// How much processor time a process has used.
#pragma once

#include <sys/types.h>

namespace chorus::bench {

/// User and system time used by a running process [s]; 0 when there is none.
[[nodiscard]] double cpu_seconds_of(pid_t pid);

}  // namespace chorus::bench
