#include "explore/mapped_memory.hpp"

#include <sys/mman.h>

#include <new>

namespace tessera::explore {

void MappedMemory::grow(std::size_t bytes) {
  constexpr std::size_t huge_page = std::size_t{2} << 20U;
  // Huge pages save most misses of the translation cache, but waste memory on small nets.
  const std::size_t granule = bytes < huge_page ? 4096 : huge_page;
  const std::size_t size = (bytes + granule - 1) / granule * granule;
  if (size <= size_) return;
  void* moved = data_ == nullptr ? mmap(nullptr, size, PROT_READ | PROT_WRITE,
                                        MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0)
                                 : mremap(data_, size_, size, MREMAP_MAYMOVE);
  if (moved == MAP_FAILED) throw std::bad_alloc();
  data_ = moved;
  size_ = size;
  if (granule == huge_page) static_cast<void>(madvise(data_, size_, MADV_HUGEPAGE));  // only advice
}

void MappedMemory::release() noexcept {
  if (data_ != nullptr) munmap(data_, size_);
  data_ = nullptr;
  size_ = 0;
}

}  // namespace tessera::explore
