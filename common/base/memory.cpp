#include "common/base/memory.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace chorus {

void return_large_blocks() {
#ifdef __GLIBC__
  // glibc's initial values.  Setting them turns off its automatic adjustment (mallopt(3)).
  constexpr int kLarge = 128 * 1024;
  ::mallopt(M_MMAP_THRESHOLD, kLarge);
  ::mallopt(M_TRIM_THRESHOLD, kLarge);
#endif
}

}  // namespace chorus
