// How much freed memory this process keeps.
#pragma once

namespace chorus {

/// Large blocks go back to the operating system when they are freed, however large blocks before
/// them were.  glibc otherwise serves blocks of up to twice the size of the largest one that was
/// freed so far from its heaps, where what lives longer keeps what is below it, so that a program
/// that runs for days grows.  Call it at the start of a program; without glibc it does nothing.
void return_large_blocks();

}  // namespace chorus
