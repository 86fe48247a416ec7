/* SPDX-License-Identifier: Apache-2.0 */
/* Loads a plugin as an engine does, and runs its plugin_main. */
#include <dlfcn.h>
#include <stdio.h>

int main(int argc, char** argv) {
  void* plugin = argc > 1 ? dlopen(argv[1], RTLD_NOW | RTLD_LOCAL) : NULL;
  if (plugin == NULL) {
    const char* problem = argc > 1 ? dlerror() : "usage: host PLUGIN";
    return fprintf(stderr, "%s\n", problem), 2;
  }
  int (*run)(void);
  *(void**)&run = dlsym(plugin, "plugin_main");
  return run == NULL ? 3 : run();
}
