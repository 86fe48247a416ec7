# SPDX-License-Identifier: Apache-2.0
"""Help, manual pages and shell completions: complete, plain, and all made from the same options."""
import pathlib
import re
import shutil
import subprocess
import unittest

from support import CUBE, FDCG, SERVO, Case

PROGRAMS = {"fdcg": (FDCG, ("compile", "validate", "repair", "batch", "inspect", "explain", "grasp", "view", "help")),
            "fdcg-servo": (SERVO, ("run", "devices", "check", "latency", "calibrate", "replay", "help"))}


def pages():
    for name, (program, commands) in PROGRAMS.items():
        yield name, (program, "--help")
        for command in commands:
            yield f"{name} {command}", (program, command, "--help")


class Help(Case):
    def test_no_page_shows_the_insides_of_the_parser(self):
        for name, command in pages():
            with self.subTest(name):
                text = self.run_program(*command).stdout.decode()
                for sign in ("{", "}", "->", "TEXT", "INT in", "FLOAT", "UINT", ":value", "REQUIRED", "|text", "[=", "\\"):
                    self.assertNotIn(sign, text)
                for group in ("Options:", "Positionals:"):
                    self.assertNotIn(group, text)

    def test_every_option_stands_in_a_group_with_a_sentence(self):
        for name, command in pages():
            with self.subTest(name):
                text = self.run_program(*command).stdout.decode()
                self.assertRegex(text, r"\A[A-Z]")
                self.assertIn(f"\nUsage: {name}", text)
                group, options = None, 0
                paragraphs = text.split("\n\n")
                for paragraph in paragraphs:
                    if not re.search(r"^  -", paragraph, re.M):
                        continue
                    group = paragraph.strip("\n").split("\n")[0]
                    self.assertRegex(group, r"^[A-Z][a-z ]+:$")
                    for option in re.split(r"\n(?=  -)", paragraph)[1:]:
                        options += 1
                        help_ = re.split(r"\s{2,}", option.strip(), maxsplit=1)
                        self.assertEqual(2, len(help_), option)
                        self.assertRegex(help_[1], r"(?s)^[A-Z].*\.$", option)
                self.assertGreater(options, 0)

    def test_lines_fit_into_a_terminal(self):
        for name, command in pages():
            text = self.run_program(*command).stdout.decode().split("\nExamples:")[0]
            self.assertEqual([], [line for line in text.split("\n") if len(line) > 80], name)

    def test_defaults_are_told_in_words(self):
        text = " ".join(self.fdcg("compile", "--help").stdout.decode().split())
        for words in ("Default: f64.", "Default: quantum.", "Default: the file's own, else m.", "Default: one for each core.", "One of f64 or f32."):
            self.assertIn(words, text)

    def test_help_command_is_what_the_option_gives(self):
        for program, commands in PROGRAMS.values():
            self.assertEqual(self.run_program(program, "--help").stdout, self.run_program(program, "help").stdout)
            for command in commands:
                self.assertEqual(self.run_program(program, command, "--help").stdout,
                                 self.run_program(program, "help", command).stdout)

    def test_wrong_usage_ends_with_the_way_to_the_help(self):
        mesh = self.write("cube.off", CUBE)
        for arguments, end in (((), "Try 'fdcg --help'."),
                               (("compile", mesh), "--output is required. Try 'fdcg compile --help'."),
                               (("compile", mesh, "-o", mesh), "Try 'fdcg compile --help'."),
                               (("compile", mesh, "--unit", "mm", "-o", "x"), "did you mean '--units'? Try 'fdcg compile --help'."),
                               (("help", "compil"), "'compil' is no command; did you mean 'compile'? Try 'fdcg help --help'."),
                               (("repair", mesh), "Try 'fdcg repair --help'.")):
            with self.subTest(arguments):
                done = self.fdcg(*arguments, code=2)
                self.assert_one_line(done)
                self.assertTrue(done.stderr.decode().startswith("fdcg: "), done.stderr)
                self.assertTrue(done.stderr.decode().endswith(end + "\n"), done.stderr)
        done = self.servo("run", code=2)
        self.assertEqual("fdcg-servo: scene is required. Try 'fdcg-servo run --help'.\n", done.stderr.decode())


class Manuals(Case):
    def setUp(self):
        super().setUp()
        for program, _ in PROGRAMS.values():
            self.run_program(program, "--write-manuals", self.path("share"), "2026-01-31")
        self.share = self.folder / "share"

    def test_each_command_has_a_page_that_the_formatter_takes(self):
        names = sorted(page.name for page in (self.share / "man1").iterdir())
        wanted = [f"{name}.1" for name in PROGRAMS]
        wanted += [f"{name}-{command}.1" for name, (_, commands) in PROGRAMS.items() for command in commands]
        self.assertEqual(sorted(wanted), names)
        if shutil.which("mandoc") is None:
            self.skipTest("mandoc is not installed")
        for page in (self.share / "man1").iterdir():
            done = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", str(page)], capture_output=True, text=True, check=False)
            self.assertEqual((0, ""), (done.returncode, done.stdout + done.stderr), page)

    def test_pages_hold_every_option_of_the_help(self):
        for name, command in pages():
            page = (self.share / "man1" / (name.replace(" ", "-") + ".1")).read_text().replace("\\-", "-")
            for option in re.findall(r"^  (-[^\n]*?)(?:  |$)", self.run_program(*command).stdout.decode(), re.M):
                self.assertIn(f".B {option}\n", page, name)

    def complete(self, program, *words):
        """What bash offers for the last of these words."""
        line = [program, *words]
        script = (f"source {self.share}/bash-completion/completions/{program}\n"
                  f"COMP_WORDS=({' '.join(repr(word) for word in line)}) COMP_CWORD={len(line) - 1}\n"
                  f"complete -p {program} >/dev/null && _{program.replace('-', '_')}\n"
                  "printf '%s\\n' \"${COMPREPLY[@]}\"\n")
        done = subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, check=True, cwd=self.folder)
        self.assertEqual("", done.stderr)
        return [word for word in done.stdout.split("\n") if word]

    def test_bash_completes_commands_options_and_values(self):
        for program in PROGRAMS:
            subprocess.run(["bash", "-n", str(self.share / "bash-completion" / "completions" / program)], check=True)
        self.assertEqual(["compile"], self.complete("fdcg", "com"))
        self.assertEqual(sorted(PROGRAMS["fdcg"][1]), sorted(self.complete("fdcg", "")))
        self.assertEqual(["--units"], self.complete("fdcg", "compile", "cube.off", "--un"))
        self.assertEqual(["m", "mm", "cm", "in"], self.complete("fdcg", "compile", "--units", ""))
        self.assertEqual(["json", "junit"], self.complete("fdcg", "validate", "--format", "=", "j"))
        self.assertEqual(["winding-inconsistent"], self.complete("fdcg", "explain", "wind"))
        self.assertEqual(["replay"], self.complete("fdcg-servo", "help", "re"))
        self.assertEqual(["slide"], self.complete("fdcg-servo", "replay", "cube.fdcg", "--path", ""))
        self.assertEqual([], self.complete("fdcg", "compile", "cu"))  # the shell's own: names of files
        options = set(re.findall(r"(?<![\w-])(--?[a-z][\w-]*)", self.fdcg("grasp", "--help").stdout.decode().split("\nExamples")[0]))
        self.assertEqual(options, set(self.complete("fdcg", "grasp", "-")))

    def test_zsh_takes_its_completions(self):
        if shutil.which("zsh") is None:
            self.skipTest("zsh is not installed")
        for program in PROGRAMS:
            subprocess.run(["zsh", "-n", str(self.share / "zsh" / "site-functions" / f"_{program}")], check=True)


if __name__ == "__main__":
    unittest.main()
