// SPDX-License-Identifier: Apache-2.0
#include "base/config.hpp"
#if FDCG_WITH_FILES
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

fdcg_status map_descriptor(int descriptor, MappedFile* file, fdcg_error* error) {
  struct stat status = {};
  if (fstat(descriptor, &status) != 0) return refuse_errno(error);
  if (S_ISDIR(status.st_mode)) return refuse(error, FDCG_E_IO, "is a directory; give an .fdcg file");
  if (!S_ISREG(status.st_mode)) return refuse(error, FDCG_E_IO, "is not a regular file and cannot be mapped");
  if (status.st_size == 0) return refuse(error, FDCG_E_IO, "is empty; compile the mesh again");
  const auto bytes = static_cast<uint64_t>(status.st_size);
  void* data = mmap(nullptr, bytes, PROT_READ, MAP_SHARED, descriptor, 0);
  if (data == MAP_FAILED) return refuse_errno(error);
  *file = {data, bytes};
  return FDCG_OK;
}

}  // namespace

fdcg_status map_file(const char* path, MappedFile* file, fdcg_error* error) {
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return refuse_errno(error);
  const fdcg_status status = map_descriptor(descriptor, file, error);
  close(descriptor);
  return status;
}

void unmap_file(const MappedFile& file) {
  munmap(file.data, file.bytes);
}

}  // namespace fdcg

#endif  // FDCG_WITH_FILES
