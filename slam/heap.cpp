#include "slam/heap.h"

#include <cstddef>  // the C library says here whether it is glibc

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace rovigo::slam {

void give_back_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace rovigo::slam
