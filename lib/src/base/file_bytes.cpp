// SPDX-License-Identifier: Apache-2.0
#include "base/file_bytes.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
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

// 0 or the errno of the failed call.
int read_to_end(int fd, std::string& buffer) {
  constexpr std::size_t kChunk = std::size_t{1} << 20;
  std::size_t used = 0;
  for (;;) {
    if (buffer.size() - used < kChunk) buffer.resize(buffer.size() + buffer.size() / 2 + kChunk);
    const ssize_t got = ::read(fd, buffer.data() + used, buffer.size() - used);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return errno;
    if (got == 0) break;
    used += static_cast<std::size_t>(got);
  }
  buffer.resize(used);
  return 0;
}

}  // namespace

Result<FileBytes> FileBytes::open(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0)
    return unreadable(path, "cannot be opened: " + error_text(errno) + "; check the path and its permissions");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return unreadable(path, "cannot be examined: " + error_text(errno));
  if (S_ISDIR(status.st_mode)) return unreadable(path, "is a directory; name a mesh file in it");
  FileBytes result;
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
  }
  if (const int error = read_to_end(file.get(), result.buffer_)) {
    return unreadable(path, "cannot be read: " + error_text(error));
  }
  return result;
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
