#!/usr/bin/env python3
"""The pages tools/viewer/page.html and tools/web/page.html are what their sources gave: each ends with a hash of all
sources and of its own text, which build.mjs writes."""
import hashlib
import pathlib
import re
import unittest

VIEWER = pathlib.Path(__file__).resolve().parents[3] / "tools/viewer"
FOLDERS = [VIEWER, VIEWER.parent / "web"]
SEAL = re.compile(r"<!-- sources and page: ([0-9a-f]{64}) -->\n\Z")


def seal_of(page):
    sources = [file for folder in FOLDERS for file in sorted((folder / "source").iterdir())]
    digest = hashlib.sha256()
    for file in [*(VIEWER / name for name in ("build.mjs", "package-lock.json", "LICENSE.three")), *sources]:
        digest.update(file.read_bytes())
    digest.update(page.encode())
    return digest.hexdigest()


class Pages(unittest.TestCase):
    def test_pages_are_what_their_sources_gave(self):
        for folder in FOLDERS:
            with self.subTest(page=folder.name):
                page = (folder / "page.html").read_text(encoding="utf-8")
                seal = SEAL.search(page)
                self.assertTrue(seal, "the page has no hash: cd tools/viewer && npm ci && npm run build")
                self.assertEqual(seal[1], seal_of(page[:seal.start()]),
                                 "the page is not what its sources give: cd tools/viewer && npm ci && npm run build")


if __name__ == "__main__":
    unittest.main()
