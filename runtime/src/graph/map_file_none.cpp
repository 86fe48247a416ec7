// SPDX-License-Identifier: Apache-2.0
// For machines without files: the graph is linked into the program or read into memory by it.
#include "base/config.hpp"
#if !FDCG_WITH_FILES
#include "base/message.hpp"
#include "graph/map_file.hpp"

namespace fdcg {

fdcg_status map_file(const char* /*path*/, const fdcg_open_options& /*options*/, MappedFile* /*file*/, fdcg_error* error) {
  return Message(error, FDCG_E_IO).text("this library was built without files (FDCG_WITH_FILES); use fdcg_open_memory");
}

void unmap_file(const MappedFile& /*file*/) {}

}  // namespace fdcg

#endif  // !FDCG_WITH_FILES
