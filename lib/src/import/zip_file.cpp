// SPDX-License-Identifier: Apache-2.0
#include "import/zip_file.hpp"

#include <zip.h>

#include <algorithm>
#include <new>

#include "shared/json/reader.hpp"
#include "shared/text.hpp"

namespace fdcg::bake {

struct ZipFile::Archive {
  zip_t* zip = nullptr;
  ~Archive() {
    if (zip != nullptr) zip_discard(zip);
  }
};

namespace {

constexpr std::uint64_t kFreeBytes = std::uint64_t{1} << 18, kEachByte = 100;

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

[[noreturn]] void fail(const std::string& what) {
  throw json::Refusal{what + "; fetch or export the file again"};
}

struct Closer {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

}  // namespace

ZipFile::ZipFile(std::string_view bytes)
    : archive_(std::make_unique<Archive>()), room_(kFreeBytes + kEachByte * bytes.size()), limit_(room_) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (source == nullptr) throw std::bad_alloc();
  archive_->zip = zip_open_from_source(source, ZIP_RDONLY, &error);
  if (archive_->zip == nullptr) {
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    zip_source_free(source);
    fail("is a ZIP archive that cannot be opened (" + why + ")");
  }
  zip_error_fini(&error);
}

ZipFile::~ZipFile() = default;

std::optional<std::string> ZipFile::read(std::string_view name) {
  const std::string wanted(name), shown = "part '" + printable(name, 64) + "' of the archive ";
  const zip_int64_t index = zip_name_locate(archive_->zip, wanted.c_str(), ZIP_FL_NOCASE);
  if (index < 0) return std::nullopt;
  zip_stat_t about;
  if (zip_stat_index(archive_->zip, static_cast<zip_uint64_t>(index), 0, &about) != 0) fail(shown + "cannot be found");
  if ((about.valid & ZIP_STAT_ENCRYPTION_METHOD) != 0 && about.encryption_method != ZIP_EM_NONE)
    throw json::Refusal{shown + "is encrypted; export the file without a password"};
  const std::unique_ptr<zip_file_t, Closer> file(zip_fopen_index(archive_->zip, static_cast<zip_uint64_t>(index), 0));
  if (!file) fail(shown + "cannot be unpacked (" + zip_strerror(archive_->zip) + ")");
  std::string bytes;
  for (constexpr std::size_t kChunk = std::size_t{1} << 16;;) {
    const std::size_t used = bytes.size();
    bytes.resize(used + std::max(kChunk, used / 2));  // what the archive says of its size is not trusted
    const zip_int64_t got = zip_fread(file.get(), bytes.data() + used, bytes.size() - used);
    if (got < 0) fail(shown + "is damaged (" + zip_file_strerror(file.get()) + ")");
    bytes.resize(used + static_cast<std::size_t>(got));
    if (static_cast<std::uint64_t>(got) > room_) {
      throw json::Refusal{shown + "unpacks to more than the " + std::to_string(limit_) +
                          " bytes that all parts of an archive of this size may have; unpack it and export the mesh again"};
    }
    room_ -= static_cast<std::uint64_t>(got);
    if (got == 0) return bytes;
  }
}

std::string ZipFile::find_ending(std::string_view ending) const {
  const zip_int64_t count = zip_get_num_entries(archive_->zip, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(archive_->zip, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
    if (name != nullptr && lower(name).ends_with(ending)) return name;
  }
  return {};
}

}  // namespace fdcg::bake
