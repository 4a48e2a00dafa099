"""Builds the module by CMake. CMAKE_ARGS in the environment are further options of it: with
-DWEFT_INSTALLED=ON an installed weft is used, and otherwise the sources two folders above."""
import atexit
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = pathlib.Path(__file__).resolve().parent
SCRATCH = tempfile.mkdtemp(prefix="weft-")  # nothing is written into the sources
atexit.register(shutil.rmtree, SCRATCH, ignore_errors=True)


def version():
    return re.search(r'__version__ = "(.*)"', (HERE / "weft/__init__.py").read_text()).group(1)


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        target = pathlib.Path(self.get_ext_fullpath(extension.name)).resolve().parent
        build = pathlib.Path(SCRATCH) / "cmake"
        subprocess.run(["cmake", "-S", HERE, "-B", build, "-DCMAKE_BUILD_TYPE=Release",
                        "-DCMAKE_UNITY_BUILD=ON",  # sources compile together, sooner
                        f"-DPython_EXECUTABLE={sys.executable}",
                        *shlex.split(os.environ.get("CMAKE_ARGS", ""))], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "weft_python",
                        "--parallel", str(len(os.sched_getaffinity(0)))], check=True)
        module, = (build / "weft").glob("_weft.*.so")
        target.mkdir(parents=True, exist_ok=True)
        self.copy_file(str(module), str(target))


setup(
    name="weft",
    version=version(),
    description="A cloth simulation library",
    packages=["weft"],
    package_data={"weft": ["py.typed", "__init__.pyi"]},
    ext_modules=[Extension("weft._weft", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    python_requires=">=3.11",
    install_requires=["numpy"],
    options={"build": {"build_base": SCRATCH}, "egg_info": {"egg_base": SCRATCH}},
    zip_safe=False,
)
