# SPDX-License-Identifier: Apache-2.0
"""schemas/rules.md lists the rules as the program knows them."""
import re
import unittest

from support import Case, ROOT


class RulesTable(Case):
    def known(self):
        """Name, severity and meaning of each rule, as fdcg explain lists them."""
        lines = self.fdcg("explain").stdout.decode().splitlines()
        return [tuple(re.split(r" +", line, maxsplit=2)) for line in lines]

    def test_the_table_has_every_rule_with_its_severity_and_what_it_counts(self):
        text = (ROOT / "schemas" / "rules.md").read_text()
        rows = [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in text.splitlines()
                if line.startswith("| `")]
        self.assertEqual([(f"`{name}`", severity, meaning) for name, severity, meaning in self.known()],
                         [row[:3] for row in rows])
        self.assertGreaterEqual(len(rows), 20)

    def test_the_last_column_says_whether_compile_can_be_told_to_allow_it(self):
        text = (ROOT / "schemas" / "rules.md").read_text()
        for line in text.splitlines():
            if not line.startswith("| `"):
                continue
            name, severity, _, allowed = (cell.strip() for cell in line.strip("|").split("|"))
            name = name.strip("`")
            with self.subTest(rule=name):
                refused = self.fdcg("compile", self.path("none.off"), "-o", self.path("none.fdcg"), "--allow", name,
                                    code=3 if allowed == "yes" else 2)
                self.assertIn(b"none.off" if allowed == "yes" else b"cannot be allowed", refused.stderr)

    def test_the_documents_point_to_the_table(self):
        self.assertIn("schemas/rules.md", (ROOT / "docs" / "validate.md").read_text())


if __name__ == "__main__":
    unittest.main()
