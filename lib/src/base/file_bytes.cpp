// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace fdcg::bake {
namespace {

// Closes the descriptor on every return path.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

Failure unreadable(const std::filesystem::path& path, const std::string& what) {
  return Failure{3, path.string() + ": " + what, "unreadable"};
}

std::string error_text(int code) {
  return std::generic_category().message(code);
}

// Character devices have no end, but for the null device, which is empty, and terminals, where a person ends the text.
bool is_endless_device(const struct stat& status) {
  struct stat null_device {};
  if (!S_ISCHR(status.st_mode)) return S_ISBLK(status.st_mode);
  if (::stat("/dev/null", &null_device) == 0 && null_device.st_rdev == status.st_rdev) return false;
  constexpr unsigned kMemoryDevices = 1;  // zero, full, random, mem, ...
  return major(status.st_rdev) == kMemoryDevices;
}

// 0 or the errno of the failed call. A file of another size than it had is read as it is now.
int read_small(int fd, std::size_t size, std::string& buffer) {
  buffer.resize(size);
  for (std::size_t at = 0; at < size;) {
    const ssize_t got = ::read(fd, buffer.data() + at, size - at);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) buffer.resize(size = at);
    at += static_cast<std::size_t>(got);
  }
  return 0;
}

// 0 or the errno of the failed call; EFBIG beyond the limit of streams.
int read_to_end(int fd, std::string& buffer) {
  std::string chunk(std::size_t{1} << 18, '\0');
  buffer.reserve(kMostStreamBytes);  // address space alone: no copy of what is there while it grows
  for (;;) {
    const ssize_t got = ::read(fd, chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) return 0;
    if (static_cast<std::size_t>(got) > kMostStreamBytes - buffer.size()) return EFBIG;
    buffer.append(chunk, 0, static_cast<std::size_t>(got));
  }
}

}  // namespace

Result<FileBytes> FileBytes::open(const std::filesystem::path& path, const std::string& what) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0)
    return unreadable(path, "cannot be opened: " + error_text(errno) + "; check the path and its permissions");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return unreadable(path, "cannot be examined: " + error_text(errno));
  if (S_ISDIR(status.st_mode)) return unreadable(path, "is a directory; name " + what + " in it");
  if (is_endless_device(status)) return unreadable(path, "is a device, which has no end; name " + what);
  FileBytes result;
  constexpr off_t kSmall = off_t{1} << 17;  // to map it, to fault its pages in and to forget them would cost more
  if (S_ISREG(status.st_mode) && status.st_size > 0 && status.st_size <= kSmall) {
    if (const int error = read_small(file.get(), static_cast<std::size_t>(status.st_size), result.buffer_))
      return unreadable(path, "cannot be read: " + error_text(error));
    return result;
  }
  // Files of /proc and /sys report size 0 but have content, so only a positive size is trusted.
  if (S_ISREG(status.st_mode) && status.st_size > 0) {
    int flags = MAP_PRIVATE;
#ifdef MAP_POPULATE
    flags |= MAP_POPULATE;  // every byte is read anyhow, and one call is cheaper than a fault a page
#endif
    void* mapping = ::mmap(nullptr, static_cast<std::size_t>(status.st_size), PROT_READ, flags, file.get(), 0);
    if (mapping != MAP_FAILED) {
      result.mapping_ = mapping;
      result.size_ = static_cast<std::size_t>(status.st_size);
      return result;
    }
    if (static_cast<std::size_t>(status.st_size) > kMostStreamBytes) {
      return unreadable(path, "needs more memory than there is (" + std::to_string(status.st_size) +
                                  " bytes of file); cut the mesh into parts");
    }
  }
  if (const int error = read_to_end(file.get(), result.buffer_)) {
    if (error == EFBIG) return unreadable(path, stream_too_long());
    return unreadable(path, "cannot be read: " + error_text(error));
  }
  return result;
}

std::string stream_too_long() {
  return "has more than " + std::to_string(kMostStreamBytes >> 20) +
         " MiB, as much as is read of what is no regular file; save it as a file";
}

FileBytes::FileBytes(FileBytes&& other) noexcept
    : mapping_(std::exchange(other.mapping_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      buffer_(std::move(other.buffer_)) {}

FileBytes& FileBytes::operator=(FileBytes&& other) noexcept {
  std::swap(mapping_, other.mapping_);
  std::swap(size_, other.size_);
  std::swap(buffer_, other.buffer_);
  return *this;
}

FileBytes::~FileBytes() {
  if (mapping_ != nullptr) ::munmap(mapping_, size_);
}

}  // namespace fdcg::bake
