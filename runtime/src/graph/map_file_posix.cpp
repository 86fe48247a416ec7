// SPDX-License-Identifier: Apache-2.0
#include "base/config.hpp"
#if FDCG_WITH_FILES && !defined(_WIN32)
#include <errno.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/message.hpp"
#include "graph/map_file.hpp"

namespace fdcg {
namespace {

// errno in words. Not strerror: it may use the heap, and is not for several threads.
fdcg_status refuse_errno(fdcg_error* error) {
  switch (errno) {
    case ENOENT:
    case ENOTDIR:
      return refuse(error, FDCG_E_IO, "No such file or directory");
    case EACCES:
    case EPERM:
      return refuse(error, FDCG_E_IO, "Permission denied");
    case EMFILE:
    case ENFILE:
      return refuse(error, FDCG_E_IO, "Too many open files");
    case ENAMETOOLONG:
      return refuse(error, FDCG_E_IO, "File name too long");
    case ENOMEM:
      return refuse(error, FDCG_E_IO, "Cannot allocate memory");
    default:
      return Message(error, FDCG_E_IO).say("the system refuses it with error number ", errno);
  }
}

constexpr uint64_t kHugePage = uint64_t{1} << 21;

// Pages that exist before the first tick needs them. Linux does it in the call; elsewhere one byte of each is read.
void populate(const void* data, uint64_t bytes) {
  constexpr uint64_t kLeastPage = 4096;
  (void)madvise(const_cast<void*>(data), bytes, MADV_WILLNEED);
  const auto* const at = static_cast<const volatile unsigned char*>(data);
  for (uint64_t i = 0; i < bytes; i += kLeastPage)
    (void)at[i];
}

fdcg_status map_shared(int descriptor, uint64_t bytes, bool is_populated, MappedFile* file, fdcg_error* error) {
  int flags = MAP_SHARED;
#ifdef MAP_POPULATE
  if (is_populated) flags |= MAP_POPULATE;
#endif
  void* data = mmap(nullptr, bytes, PROT_READ, flags, descriptor, 0);
  if (data == MAP_FAILED) return refuse_errno(error);
  if (is_populated) populate(data, bytes);
  *file = {data, bytes};
  return FDCG_OK;
}

bool read_whole(int descriptor, unsigned char* to, uint64_t bytes) {
  for (uint64_t at = 0; at < bytes;) {
    constexpr uint64_t kMostAtOnce = 1 << 30;
    const uint64_t left = bytes - at;
    const ssize_t got = read(descriptor, to + at, left < kMostAtOnce ? left : kMostAtOnce);
    if (got > 0) {
      at += static_cast<uint64_t>(got);
    } else if (got == 0) {
      errno = EIO;  // the file has become shorter
      return false;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

// A copy in memory that starts at a huge page, so that the system can use such pages for it: a file's own pages are small.
fdcg_status copy_to_huge_pages(int descriptor, uint64_t bytes, MappedFile* file, fdcg_error* error) {
  const uint64_t page = static_cast<uint64_t>(sysconf(_SC_PAGESIZE)), whole = (bytes + page - 1) / page * page;
  void* const room = mmap(nullptr, whole + kHugePage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) return refuse_errno(error);
  auto* const begin = static_cast<unsigned char*>(room);
  const uint64_t before = (kHugePage - reinterpret_cast<uintptr_t>(room) % kHugePage) % kHugePage;
  unsigned char* const data = begin + before;
  if (before > 0) munmap(begin, before);
  munmap(data + whole, kHugePage - before);
#ifdef MADV_HUGEPAGE
  (void)madvise(data, whole, MADV_HUGEPAGE);  // a system without them gives small ones
#endif
  if (!read_whole(descriptor, data, bytes)) {
    const fdcg_status status = refuse_errno(error);
    munmap(data, whole);
    return status;
  }
  (void)mprotect(data, whole, PROT_READ);
  *file = {data, bytes};
  return FDCG_OK;
}

fdcg_status map_descriptor(int descriptor, const fdcg_open_options& options, MappedFile* file, fdcg_error* error) {
  struct stat status = {};
  if (fstat(descriptor, &status) != 0) return refuse_errno(error);
  if (S_ISDIR(status.st_mode)) return refuse(error, FDCG_E_IO, "is a directory; give an .fdcg file");
  if (!S_ISREG(status.st_mode)) return refuse(error, FDCG_E_IO, "is not a regular file and cannot be mapped");
  if (status.st_size == 0) return refuse(error, FDCG_E_IO, "is empty; compile the mesh again");
  const auto bytes = static_cast<uint64_t>(status.st_size);
  if (options.huge_pages != 0) return copy_to_huge_pages(descriptor, bytes, file, error);
  return map_shared(descriptor, bytes, options.populate != 0, file, error);
}

}  // namespace

fdcg_status map_file(const char* path, const fdcg_open_options& options, MappedFile* file, fdcg_error* error) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return refuse_errno(error);
  const fdcg_status status = map_descriptor(descriptor, options, file, error);
  close(descriptor);
  return status;
}

void unmap_file(const MappedFile& file) {
  munmap(file.data, file.bytes);
}

}  // namespace fdcg

#endif  // FDCG_WITH_FILES && !defined(_WIN32)
