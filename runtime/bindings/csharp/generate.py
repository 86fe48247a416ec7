# SPDX-License-Identifier: Apache-2.0
"""Fdcg.cs: the declarations of the runtime's C headers for C#. `python3 generate.py --write` renews it; a test checks that it is
current. 64-bit processes alone: that is what engines are."""
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
INCLUDE = HERE.parents[1] / "include" / "fdcg"
HEADERS = ("fdcg.h", "visual.h", "query.h", "effect.h", "relief.h", "heights.h", "scene.h", "scene_state.h", "surface.h", "soft_finger.h", "body.h", "pile.h", "deform.h")  # each after what it includes
PLAIN = {"uint8_t": "byte", "uint16_t": "ushort", "uint32_t": "uint", "uint64_t": "ulong", "int16_t": "short", "int": "int", "int32_t": "int",
         "double": "double", "float": "float", "char": "byte", "void": "void"}
OPAQUE = {"fdcg_scene", "fdcg_pile", "fdcg_deform"}
# of format.h, which C# sees by pointers alone
FORMAT = {"fdcg_header", "fdcg_connection", "fdcg_busy_corner", "fdcg_box8", "fdcg_material_record", "fdcg_fan_run", "fdcg_node_normals"}
KEYWORDS = {"object": "@object", "in": "@in", "params": "@params", "ref": "@ref"}

HEAD = """// SPDX-License-Identifier: Apache-2.0
// Made by runtime/bindings/csharp/generate.py from the C headers, which have the documentation: do not edit.
//
// The names and layouts of the C API, in 64-bit processes; libfdcg.so or fdcg.dll must be where the system looks for libraries.
// Frames are right-handed. An engine whose frames are left-handed (Unity) negates the z of positions and forces, and the x and y
// of quaternions, on the way in and out.
using System;
using System.Runtime.InteropServices;

namespace Fdcg {
"""


def strip(text):
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    return re.sub(r"^[ \t]*#.*$", "", text, flags=re.M)


def name_of(name):
    return KEYWORDS.get(name, name)


class Headers:
    def __init__(self):
        self.constants, self.enums, self.structs, self.functions = {}, [], [], []
        for name in ("format.h", *HEADERS):
            text = (INCLUDE / name).read_text()
            self.constants.update(re.findall(r"^#define (FDCG_\w+) (\w+?)u?(?:\s|$)", text, re.M))
            if name == "format.h":
                continue
            bare = strip(text)
            self.enums += re.findall(r"typedef enum (\w+) \{(.*?)\} \w+;", bare, re.S)
            self.structs += re.findall(r"typedef struct (\w+) \{(.*?)\} \w+;", bare, re.S)
            self.functions += [(" ".join(result.split()), function, " ".join(arguments.split())) for result, function, arguments in
                               re.findall(r"^FDCG_(?:API|INLINE) ([\w\s*]+?[\s*])(fdcg_\w+)\((.*?)\)\s*[;{]", bare, re.M | re.S)]
        self.known = {name for name, _ in self.structs}
        self.enum_names = {name for name, _ in self.enums}

    def number(self, text):
        if text.startswith("sizeof(void*) == 8 ?"):
            return int(text.split("?")[1].split(":")[0])
        return int(self.constants.get(text, text).rstrip("u"), 0)

    def type_of(self, text):
        """A C type as C# has it: pointers to what is opaque, or in a file, are IntPtr."""
        text = re.sub(r"\b(const|struct)\b", "", text)
        stars, base = text.count("*"), text.replace("*", "").strip()
        if base in OPAQUE or base in FORMAT:
            return "IntPtr" + "*" * (stars - 1)
        if base.endswith("_handler"):
            return "IntPtr"
        if base == "void" and stars > 0:
            return "IntPtr" + "*" * (stars - 1)
        if base in PLAIN:
            return PLAIN[base] + "*" * stars
        if base in self.known or base in self.enum_names:
            return base + "*" * stars
        raise ValueError(f"generate.py: no type for {text!r}")

    def fields_of(self, body):
        for field in filter(None, (line.strip() for line in body.split(";"))):
            match = re.fullmatch(r"(.*?)(\w+)((?:\[[^\]]*\])*)", " ".join(field.split()))
            kind, name, sizes = self.type_of(match.group(1)), name_of(match.group(2)), re.findall(r"\[([^\]]*)\]", match.group(3))
            if not sizes:
                yield f"public {kind} {name};"
                continue
            count = 1
            for size in sizes:
                count *= self.number(size)
            yield f"public {kind} {name};" if count == 1 else f"public fixed {kind} {name}[{count}];"

    def arguments_of(self, text):
        if text in ("void", ""):
            return
        for argument in text.split(","):
            argument = argument.strip()
            if match := re.fullmatch(r"(.*?)\(\*(\w+)\)\[\d+\]", argument):  # an array of rows
                yield f"{self.type_of(match.group(1) + '*')} {name_of(match.group(2))}"
                continue
            kind, name, size = re.fullmatch(r"(.*?)(\w+)((?:\[\d*\])?)", argument).groups()
            if kind.strip() == "const char*":
                yield f"[MarshalAs(UnmanagedType.LPStr)] string {name_of(name)}"
            else:
                yield f"{self.type_of(kind + ('*' if size else ''))} {name_of(name)}"

    def result_of(self, text):
        return "IntPtr" if text == "const char*" else self.type_of(text)

    def source(self):
        parts = [HEAD]
        for name, body in self.enums:
            members = [" ".join(member.split()) for member in body.split(",") if member.strip()]
            parts.append(f"  public enum {name} {{\n" + "".join(f"    {member},\n" for member in members) + "  }\n\n")
        for name, body in self.structs:
            fields = "".join(f"    {field}\n" for field in self.fields_of(body))
            parts.append(f"  [StructLayout(LayoutKind.Sequential)]\n  public unsafe struct {name} {{\n{fields}  }}\n\n")
        parts.append("  public static unsafe class Native {\n    const string Library = \"fdcg\";\n    public const uint FDCG_NONE = 0xFFFFFFFF;\n")
        for result, name, arguments in self.functions:
            parts.append(f"\n    [DllImport(Library, CallingConvention = CallingConvention.Cdecl)]\n"
                         f"    public static extern {self.result_of(result)} {name}({', '.join(self.arguments_of(arguments))});\n")
        parts.append("  }\n}\n")
        return "".join(parts)


if __name__ == "__main__":
    source = Headers().source()
    if "--write" in sys.argv:
        (HERE / "Fdcg.cs").write_text(source)
    elif (HERE / "Fdcg.cs").read_text() != source:
        sys.exit("Fdcg.cs is not what the headers say; run: python3 runtime/bindings/csharp/generate.py --write")
