#include "solvers/linear/huge_pages.hpp"

#include <cstdint>

#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace drev {

void prefer_huge_pages([[maybe_unused]] const void* untouched, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t kPage = 4096, kSmall = std::uintptr_t{1} << 22;
  if (bytes < kSmall) return;
  const auto start = reinterpret_cast<std::uintptr_t>(untouched);
  const std::uintptr_t begin = (start + kPage - 1) / kPage * kPage, end = (start + bytes) / kPage * kPage;
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

}  // namespace drev
