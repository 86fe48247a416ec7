# SPDX-License-Identifier: Apache-2.0
"""A recipe (Conan 2) of the runtime, of the sources that this folder is part of: conan create tools/packaging/conan"""
import os
import re

from conan import ConanFile
from conan.tools.cmake import CMake, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load

SOURCES = ("CMakeLists.txt", "LICENSE", "README.md", "CHANGELOG.md", "cmake/*", "docs/*", "runtime/*", "schemas/*")


class Fdcg(ConanFile):
    name = "fdcg"
    description = "Contact with polygon models for force-feedback devices: the runtime"
    license = "Apache-2.0"
    topics = ("haptics", "simulation", "contact", "friction")
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"with_f64": [True, False], "with_f32": [True, False], "with_files": [True, False], "with_messages": [True, False],
               "with_friction_terms": [True, False], "with_busy_corners": [True, False], "with_inexact_nodes": [True, False],
               "with_clear_balls": [True, False], "with_fast_edges": [True, False], "with_shading": [True, False],
               "with_derived_planes": [True, False], "with_fast_faces": [True, False], "with_status_texts": [True, False]}
    default_options = {name: True for name in options}

    def _root(self):
        return os.path.abspath(os.path.join(self.recipe_folder, "..", "..", ".."))

    def set_version(self):
        self.version = re.search(r"project\(fdcg VERSION ([\d.]+)", load(self, os.path.join(self._root(), "CMakeLists.txt")))[1]

    def export_sources(self):
        for pattern in SOURCES:
            copy(self, pattern, src=self._root(), dst=self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        for name in ("RUNTIME_ONLY", "INSTALL"):
            toolchain.cache_variables["FDCG_" + name] = True
        for name in ("BUILD_TESTS", "WERROR"):
            toolchain.cache_variables["FDCG_" + name] = False
        for name in self.options.possible_values:
            toolchain.cache_variables["FDCG_" + name.upper()] = bool(getattr(self.options, name))
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", src=self.source_folder, dst=os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        """CMake finds the project's own package, with all of its targets; Conan makes none of its own."""
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = [os.path.join("lib", "cmake", "fdcg")]
        self.cpp_info.libs = ["fdcg_runtime"]
        if self.settings.os != "Windows":
            self.cpp_info.system_libs = ["m"]
