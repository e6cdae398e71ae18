// How much freed memory this process keeps.
#pragma once

namespace chorus {

/// Makes blocks of 128 kB and more go back to the operating system as soon as they are freed.  By
/// default, glibc raises this limit to the size of the largest such block that was freed.  Smaller
/// blocks then come from heaps, which cannot shrink below a block that is still in use, so that a
/// program that runs for days grows.  Call it at the start of a program; without glibc it does
/// nothing.
void return_large_blocks();

}  // namespace chorus
