# SPDX-License-Identifier: Apache-2.0
"""tools/sbom, tools/release, CITATION.cff: what is handed out with the sources."""
import hashlib
import json
import os
import pathlib
import re
import subprocess
import tarfile
import tempfile
import unittest

from pages import ROOT

VERSION = re.search(r"project\(fdcg VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
RELATIONS = {"DESCRIBES", "CONTAINS", "DEPENDS_ON", "BUILD_TOOL_OF", "TEST_DEPENDENCY_OF", "DEV_TOOL_OF"}


def run(*command, code=0, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=200, **options)
    assert done.returncode == code, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done


def package_groups():
    lines = (ROOT / "tools" / "packages").read_text().splitlines()
    return {match[1]: match[2].split() for match in (re.match(r"^(\w+): (.*)$", line) for line in lines) if match}


class BillOfMaterials(unittest.TestCase):
    """Against the rules of the SPDX 2.3 specification that concern what it has."""

    def setUp(self):
        self.text = run(ROOT / "tools" / "sbom", "-o", "-").stdout
        self.document = json.loads(self.text)
        self.by_id = {package["SPDXID"]: package for package in self.document["packages"]}

    def test_it_is_an_spdx_document(self):
        document = self.document
        self.assertEqual(("SPDX-2.3", "CC0-1.0", "SPDXRef-DOCUMENT"), tuple(document[key] for key in ("spdxVersion", "dataLicense", "SPDXID")))
        self.assertRegex(document["documentNamespace"], r"^https://[^#\s]+$")
        self.assertRegex(document["creationInfo"]["created"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        for creator in document["creationInfo"]["creators"]:
            self.assertRegex(creator, r"^(Tool|Person|Organization): \S")
        self.assertEqual(len(document["packages"]), len(self.by_id), "identifiers are unique")
        for package in document["packages"]:
            self.assertRegex(package["SPDXID"], r"^SPDXRef-[A-Za-z0-9.-]+$")
            self.assertTrue(package["name"] and package["downloadLocation"])
            self.assertIs(package["filesAnalyzed"], False)
            for reference in package.get("externalRefs", []):
                self.assertEqual(("PACKAGE-MANAGER", "purl"), (reference["referenceCategory"], reference["referenceType"]))
                self.assertRegex(reference["referenceLocator"], r"^pkg:(deb/debian/[a-z0-9.+-]+@[^?\s+]+\?arch=\w+|npm/[a-z0-9%/._-]+@[\d.]+)$")

    def test_relations_name_what_is_there(self):
        ids = set(self.by_id) | {"SPDXRef-DOCUMENT"}
        related = set()
        for relation in self.document["relationships"]:
            self.assertIn(relation["relationshipType"], RELATIONS)
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, ids)
            related |= {relation["spdxElementId"], relation["relatedSpdxElement"]}
        self.assertEqual(set(), ids - related, "each is related to something")
        self.assertFalse([relation for relation in self.document["relationships"] if relation["relationshipType"] == "DEPENDS_ON" and
                          relation["spdxElementId"].endswith("fdcg-runtime")], "the runtime depends on nothing")

    def test_every_package_is_in_it_with_the_version_that_is_installed(self):
        packages = {package["name"]: package for package in self.document["packages"]}
        known = 0
        for names in {names for group in package_groups().values() for names in group}:
            found = [name for name in names.split("|") if name in packages]  # "one|other": what different systems have
            self.assertEqual(1, len(found), names)
            name = found[0]
            try:
                done = subprocess.run(("dpkg-query", "-W", "-f", "${Version}", name), capture_output=True, text=True, check=False)
            except FileNotFoundError:
                self.skipTest("this is not a Debian system")
            if done.returncode == 0 and done.stdout:
                known += 1
                self.assertEqual(done.stdout, packages[name]["versionInfo"])
                self.assertIn("Debian's copyright file names", packages[name].get("licenseComments", "Debian's copyright file names"))
        self.assertGreater(known, 10)
        self.assertEqual(VERSION, packages["fdcg"]["versionInfo"])

    def test_again_it_has_the_same_bytes(self):
        self.assertEqual(self.text, run(ROOT / "tools" / "sbom", "-o", "-").stdout)


@unittest.skipUnless((ROOT / ".git").exists(), "not a git checkout")
class Files(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def released(self, name):
        run(ROOT / "tools" / "release", "--revision", "HEAD", "--output", self.folder / name)
        return self.folder / name

    def test_archive_notes_and_checksums_belong_together(self):
        output = self.released("one")
        archive = f"fdcg-{VERSION}.tar.gz"
        self.assertEqual({archive, "NOTES.md", "SHA256SUMS", "sbom.spdx.json"}, {path.name for path in output.iterdir()})
        sums = dict(line.split("  ")[::-1] for line in (output / "SHA256SUMS").read_text().splitlines())
        self.assertEqual({archive, "NOTES.md", "sbom.spdx.json"}, set(sums))
        for name, digest in sums.items():
            self.assertEqual(digest, hashlib.sha256((output / name).read_bytes()).hexdigest())
        with tarfile.open(output / archive) as files:
            names = {member.name for member in files if not member.isdir()}
        tracked = run("git", "-C", ROOT, "ls-tree", "-r", "--name-only", "-z", "HEAD").stdout.split("\0")[:-1]
        self.assertEqual({f"fdcg-{VERSION}/{name}" for name in tracked}, names)
        notes = (output / "NOTES.md").read_text()
        self.assertIn("fdcg compile", notes)
        self.assertNotIn("\n## ", notes)

    def test_the_same_commit_gives_the_same_archive(self):
        one, two = (self.released(name) / f"fdcg-{VERSION}.tar.gz" for name in ("one", "two"))
        self.assertEqual(one.read_bytes(), two.read_bytes())

    def test_the_archive_can_be_configured(self):
        archive = self.released("one") / f"fdcg-{VERSION}.tar.gz"
        with tarfile.open(archive) as files:
            files.extractall(self.folder / "tree")
        tree = self.folder / "tree" / f"fdcg-{VERSION}"
        run("cmake", "--preset", "runtime-only", cwd=tree, env=os.environ | {"HOME": str(self.folder)})

    def test_an_unknown_revision_is_wrong_usage(self):
        done = run(ROOT / "tools" / "release", "--revision", "no-such-revision", "--output", self.folder / "none", code=2)
        self.assertIn("no-such-revision", done.stderr)
        self.assertFalse((self.folder / "none").exists())


class Citation(unittest.TestCase):
    def test_it_names_this_version_and_the_paper(self):
        text = (ROOT / "CITATION.cff").read_text()
        self.assertRegex(text, rf"(?m)^version: {re.escape(VERSION)}$")
        for field in ("cff-version: 1.2.0", "message:", "title: fdcg", "authors:", "license: Apache-2.0"):
            self.assertRegex(text, rf"(?m)^{re.escape(field)}")
        self.assertIn("Extending the friction cone algorithm", text)


if __name__ == "__main__":
    unittest.main()
