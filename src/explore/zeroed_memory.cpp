#include "explore/zeroed_memory.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <cstring>
#include <new>

namespace tessera::explore {
namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20U;
// To map, touch and unmap a page takes tens of microseconds in some virtual machines. Searches of small nets are many.
constexpr std::size_t most_of_heap = std::size_t{64} << 10U;

bool on_heap(std::size_t size) { return size <= most_of_heap; }

// Huge pages save most misses of the translation cache, but waste memory on small nets.
std::size_t size_for(std::size_t bytes) {
  if (on_heap(bytes)) return bytes;
  const std::size_t granule = bytes < huge_page ? 4096 : huge_page;
  return (bytes + granule - 1) / granule * granule;
}

// It takes no RAM until it is used.
void* map(std::size_t size) {
  void* mapped =
      mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return mapped == MAP_FAILED ? nullptr : mapped;
}

void* map_more(void* data, std::size_t old_size, std::size_t size) {
  void* moved = mremap(data, old_size, size, MREMAP_MAYMOVE);
  return moved == MAP_FAILED ? nullptr : moved;
}

}  // namespace

void ZeroedMemory::grow(std::size_t bytes) {
  const std::size_t size = size_for(bytes);
  if (size <= size_) return;
  void* grown = nullptr;
  if (!on_heap(size) && !on_heap(size_)) {
    grown = map_more(data_, size_, size);
  } else {
    grown = on_heap(size) ? std::calloc(size, 1) : map(size);
    if (grown != nullptr && data_ != nullptr) {
      std::memcpy(grown, data_, size_);
      std::free(data_);
    }
  }
  if (grown == nullptr) throw std::bad_alloc();
  data_ = grown;
  size_ = size;
  if (size_ >= huge_page) static_cast<void>(madvise(data_, size_, MADV_HUGEPAGE));  // only advice
}

void ZeroedMemory::release() noexcept {
  if (on_heap(size_))
    std::free(data_);
  else
    munmap(data_, size_);
  data_ = nullptr;
  size_ = 0;
}

}  // namespace tessera::explore
