// SPDX-License-Identifier: Apache-2.0
// The version of the library and the texts of its status codes.
#include "fdcg/fdcg.h"

extern "C" uint32_t fdcg_version(void) {
  return FDCG_VERSION;
}

extern "C" const char* fdcg_status_text(fdcg_status status) {
  static const char* const kTexts[] = {"no error",
                                       "an argument is a null pointer or out of range",
                                       "the file cannot be opened, read or mapped",
                                       "the memory is not aligned",
                                       "the file is longer or shorter than its header promises",
                                       "not an FDCG file",
                                       "a format version or precision that this library does not read",
                                       "header and section table contradict themselves",
                                       "bytes have changed since the file was written",
                                       "an index or a number inside a section is out of range",
                                       "the file does not hold what is asked for",
                                       "the processor or the compiler rounds otherwise than the step needs",
                                       "the mesh has errors",
                                       "there is no memory left"};
  const auto index = static_cast<uint32_t>(status);
  return index <= FDCG_E_MEMORY ? kTexts[index] : "unknown status";
}
