"""A Conan 2 recipe of the checkout that it stands in:

    conan create weft/tools/package/conan --build=missing
"""
import os
import re

from conan import ConanFile
from conan.errors import ConanInvalidConfiguration
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy, load


class Weft(ConanFile):
    name = "weft"
    description = "A cloth simulation library"
    package_type = "library"
    settings = "os", "arch", "compiler", "build_type"
    options = {"shared": [True, False], "fPIC": [True, False]}
    default_options = {"shared": False, "fPIC": True}
    implements = ["auto_shared_fpic"]

    def _checkout(self):
        return os.path.abspath(os.path.join(self.recipe_folder, "..", "..", ".."))

    def set_version(self):
        header = load(self, os.path.join(self._checkout(), "engine", "weft", "weft.h"))
        numbers = re.findall(r"#define WEFT_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header)
        self.version = ".".join(numbers)

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "engine/*", "kernels/*"):
            copy(self, pattern, src=self._checkout(), dst=self.export_sources_folder)

    def requirements(self):
        self.requires("onetbb/[>=2021.8]")
        self.requires("eigen/[>=3.4]", visible=False)
        self.requires("xsimd/[>=8.1]", visible=False)

    def validate(self):
        check_min_cppstd(self, 20)
        system, arch = str(self.settings.os), str(self.settings.arch)
        if (system, arch) not in (("Linux", "x86_64"), ("Linux", "armv8"), ("Windows", "x86_64")):
            raise ConanInvalidConfiguration("weft runs on Linux on x86-64 and aarch64, and on "
                                            f"Windows on x86-64; not on {system} on {arch}")
        if system == "Windows" and self.settings.compiler != "gcc":
            raise ConanInvalidConfiguration("on Windows weft is built by MinGW-w64 (gcc)")

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("TOOLS", "TESTS", "PERF"):
            toolchain.cache_variables[f"WEFT_BUILD_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()

    def package_info(self):
        self.cpp_info.libs = ["weft"]
        self.cpp_info.requires = ["onetbb::libtbb", "eigen::eigen", "xsimd::xsimd"]
        self.cpp_info.set_property("cmake_file_name", "weft")
        self.cpp_info.set_property("cmake_target_name", "weft::weft")
        self.cpp_info.set_property("pkg_config_name", "weft")
