// SPDX-License-Identifier: Apache-2.0
#include "base/config.hpp"
#if FDCG_WITH_FILES && defined(_WIN32)
#ifndef WIN32_LEAN_AND_MEAN
#define WIN32_LEAN_AND_MEAN
#endif
#ifndef NOMINMAX
#define NOMINMAX
#endif
#include <windows.h>

#include "base/message.hpp"
#include "graph/map_file.hpp"

namespace fdcg {
namespace {

constexpr int kLongestPath = 4096;  // UTF-16 units

// The system's error in words, those of other systems where they say the same.
fdcg_status refuse_last_error(fdcg_error* error) {
  const DWORD number = GetLastError();
  switch (number) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND:
    case ERROR_INVALID_NAME:
    case ERROR_BAD_NETPATH:
      return refuse(error, FDCG_E_IO, "No such file or directory");
    case ERROR_ACCESS_DENIED:
      return refuse(error, FDCG_E_IO, "Permission denied");
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION:
      return refuse(error, FDCG_E_IO, "Another program is writing it");
    case ERROR_TOO_MANY_OPEN_FILES:
      return refuse(error, FDCG_E_IO, "Too many open files");
    case ERROR_NOT_ENOUGH_MEMORY:
    case ERROR_OUTOFMEMORY:
    case ERROR_COMMITMENT_LIMIT:
      return refuse(error, FDCG_E_IO, "Cannot allocate memory");
    default:
      return Message(error, FDCG_E_IO).say("the system refuses it with error number ", number);
  }
}

// Closed where it goes out of scope; null and INVALID_HANDLE_VALUE are none.
class Handle {
 public:
  explicit Handle(HANDLE handle) : handle_(handle == INVALID_HANDLE_VALUE ? nullptr : handle) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (handle_ != nullptr) CloseHandle(handle_);
  }
  [[nodiscard]] HANDLE get() const { return handle_; }
  [[nodiscard]] bool is_open() const { return handle_ != nullptr; }

 private:
  HANDLE handle_;
};

// Pages that exist before the first tick needs them.
void populate(const void* data, uint64_t bytes) {
  constexpr uint64_t kPage = 4096;
  const auto* const at = static_cast<const volatile unsigned char*>(data);
  for (uint64_t i = 0; i < bytes; i += kPage)
    (void)at[i];
}

fdcg_status map_pages(HANDLE from, uint64_t bytes, bool is_populated, MappedFile* file, fdcg_error* error) {
  const Handle mapping(CreateFileMappingW(from, nullptr, PAGE_READONLY, 0, 0, nullptr));
  if (!mapping.is_open()) return refuse_last_error(error);
  void* const data = MapViewOfFile(mapping.get(), FILE_MAP_READ, 0, 0, 0);  // lives on after the handles
  if (data == nullptr) return refuse_last_error(error);
  if (is_populated) populate(data, bytes);
  *file = {data, bytes};
  return FDCG_OK;
}

// Huge pages need a privilege here that programs do not have: a copy in memory of its own, in pages as they are.
fdcg_status copy(HANDLE from, uint64_t bytes, MappedFile* file, fdcg_error* error) {
  auto* const data = static_cast<unsigned char*>(VirtualAlloc(nullptr, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE));
  if (data == nullptr) return refuse_last_error(error);
  for (uint64_t at = 0; at < bytes;) {
    constexpr uint64_t kMostAtOnce = 1 << 30;
    const uint64_t left = bytes - at;
    DWORD got = 0;
    const bool is_read =
        ReadFile(from, data + at, static_cast<DWORD>(left < kMostAtOnce ? left : kMostAtOnce), &got, nullptr) != 0;
    if (!is_read || got == 0) {
      const fdcg_status status = is_read ? refuse(error, FDCG_E_IO, "has become shorter") : refuse_last_error(error);
      VirtualFree(data, 0, MEM_RELEASE);
      return status;
    }
    at += got;
  }
  DWORD before;
  VirtualProtect(data, bytes, PAGE_READONLY, &before);
  *file = {data, bytes};
  return FDCG_OK;
}

}  // namespace

// `path` in UTF-8. While the file is open nobody else may write it.
fdcg_status map_file(const char* path, const fdcg_open_options& options, MappedFile* file, fdcg_error* error) {
  wchar_t wide[kLongestPath];
  if (MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, kLongestPath) == 0) {
    const bool is_long = GetLastError() == ERROR_INSUFFICIENT_BUFFER;
    return refuse(error, FDCG_E_IO, is_long ? "File name too long" : "the name is no UTF-8");
  }
  const DWORD attributes = GetFileAttributesW(wide);
  if (attributes == INVALID_FILE_ATTRIBUTES) return refuse_last_error(error);
  if ((attributes & FILE_ATTRIBUTE_DIRECTORY) != 0) return refuse(error, FDCG_E_IO, "is a directory; give an .fdcg file");
  const Handle from(CreateFileW(wide, GENERIC_READ, FILE_SHARE_READ, nullptr, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, nullptr));
  if (!from.is_open()) return refuse_last_error(error);
  if (GetFileType(from.get()) != FILE_TYPE_DISK) return refuse(error, FDCG_E_IO, "is not a regular file and cannot be mapped");
  LARGE_INTEGER size;
  if (GetFileSizeEx(from.get(), &size) == 0) return refuse_last_error(error);
  if (size.QuadPart == 0) return refuse(error, FDCG_E_IO, "is empty; compile the mesh again");
  const auto bytes = static_cast<uint64_t>(size.QuadPart);
  if (options.huge_pages != 0) return copy(from.get(), bytes, file, error);
  return map_pages(from.get(), bytes, options.populate != 0, file, error);
}

void unmap_file(const MappedFile& file) {
  MEMORY_BASIC_INFORMATION pages;
  const bool is_known = VirtualQuery(file.data, &pages, sizeof pages) != 0;
  if (is_known && pages.Type == MEM_PRIVATE) {
    VirtualFree(file.data, 0, MEM_RELEASE);
  } else {
    UnmapViewOfFile(file.data);
  }
}

}  // namespace fdcg

#endif  // FDCG_WITH_FILES && defined(_WIN32)
