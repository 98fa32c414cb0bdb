// Preloaded by scripts/large_pages: asks for large pages wherever a program maps much memory, as g++ does for its
// syntax trees. Programs that ask for none themselves get 4 KB at a time otherwise, each with a page fault.
#define _GNU_SOURCE
#include <errno.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

static const size_t large_page = 2 << 20;

void* mmap(void* where, size_t size, int protection, int flags, int file, off_t offset) {
  void* const memory = (void*)syscall(SYS_mmap, where, size, protection, flags, file, offset);
  if (memory != MAP_FAILED && size >= large_page && (flags & MAP_ANONYMOUS) && (flags & MAP_PRIVATE)) {
    const int error = errno;
    madvise(memory, size, MADV_HUGEPAGE);  // a hint: without it, the memory is as good
    errno = error;
  }
  return memory;
}

void* mmap64(void* where, size_t size, int protection, int flags, int file, off64_t offset) {
  return mmap(where, size, protection, flags, file, offset);
}
