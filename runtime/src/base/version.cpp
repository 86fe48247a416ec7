// SPDX-License-Identifier: Apache-2.0
// The version of the library and the texts of its status codes.
#include "fdcg/fdcg.h"

extern "C" uint32_t fdcg_version(void) {
  return FDCG_VERSION;
}

extern "C" const char* fdcg_status_text(fdcg_status status) {
  switch (status) {
    case FDCG_OK:
      return "no error";
    case FDCG_E_ARGUMENT:
      return "an argument is a null pointer or out of range";
    case FDCG_E_IO:
      return "the file cannot be opened, read or mapped";
    case FDCG_E_ALIGNMENT:
      return "the memory is not aligned";
    case FDCG_E_TRUNCATED:
      return "the file is longer or shorter than its header promises";
    case FDCG_E_MAGIC:
      return "not an FDCG file";
    case FDCG_E_VERSION:
      return "a format version or precision that this library does not read";
    case FDCG_E_LAYOUT:
      return "header and section table contradict themselves";
    case FDCG_E_CHECKSUM:
      return "bytes have changed since the file was written";
    case FDCG_E_GRAPH:
      return "an index or a number inside a section is out of range";
    case FDCG_E_ABSENT:
      return "the file does not hold what is asked for";
  }
  return "unknown status";
}
