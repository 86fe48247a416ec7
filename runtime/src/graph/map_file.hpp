// SPDX-License-Identifier: Apache-2.0
// The one call to the platform that loading needs: map_file_posix.cpp, map_file_windows.cpp, map_file_none.cpp.
#pragma once

#include "fdcg/fdcg.h"

namespace fdcg {

struct MappedFile {
  void* data = nullptr;
  uint64_t bytes = 0;
};

// Maps a regular, non-empty file read-only, its pages as the options say. Undo with unmap_file. The message says why, not which
// file.
fdcg_status map_file(const char* path, const fdcg_open_options& options, MappedFile* file, fdcg_error* error);
void unmap_file(const MappedFile& file);

}  // namespace fdcg
