// SPDX-License-Identifier: Apache-2.0
// path_hash.c in C#, by Fdcg.cs.
using System;
using Fdcg;

static unsafe class PathHash {
  static int Main(string[] args) {
    fdcg_graph graph;
    fdcg_error error;
    if (Native.fdcg_open_file(args[0], fdcg_verify.FDCG_VERIFY_SAFE, &graph, &error) != fdcg_status.FDCG_OK) {
      Console.Error.WriteLine(System.Runtime.InteropServices.Marshal.PtrToStringAnsi((IntPtr)error.message));
      return 1;
    }
    fdcg_params all = Native.fdcg_make_params();
    if (all.struct_bytes != sizeof(fdcg_params) || sizeof(fdcg_contact) != 304 || sizeof(fdcg_result) != 72) return 3;
    var contact = new fdcg_contact();
    ulong hash = 0xCBF29CE484222325;
    double* hip = stackalloc double[3];
    for (int i = 0; i < 20000; ++i) {
      hip[0] = (i * 7 % 1200) / 1200.0 * 1.2 - 0.1;
      hip[1] = (i % 977) / 977.0;
      hip[2] = i % 4000 == 0 ? 1.1 : 0.98 + (i % 101) / 10100.0;
      fdcg_result result;
      Native.fdcg_step(&graph, &all, &contact, hip, &result);
      for (int k = 0; k < 3; ++k)
        hash = unchecked((hash ^ (ulong)BitConverter.DoubleToInt64Bits(result.force_n[k])) * 0x100000001B3);
    }
    Console.WriteLine(hash.ToString("x16"));
    return Native.fdcg_close(&graph) == fdcg_status.FDCG_OK ? 0 : 2;
  }
}
