"""What pip calls that is asked for the root of the sources: setuptools, here."""
import os
import pathlib

from setuptools.build_meta import *

os.chdir(pathlib.Path(__file__).resolve().parent)
