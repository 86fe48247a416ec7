# SPDX-License-Identifier: Apache-2.0
"""The device-side protocol core (runtime/device/firmware) on a microcontroller: the same answers as here, its size, what it
needs, how long a call takes."""
import unittest

from anywhere import C, ROOT, AnywhereCase, qemu

CORE = ROOT / "runtime" / "device" / "firmware"
WALK = str(ROOT / "tests" / "anywhere" / "device_firmware.c")
LIMIT_BYTES = 2048  # code and constants on a Cortex-M7 at -Os, the report descriptor among them
LIMIT_INSTRUCTIONS = 2000  # a call: 10 us at 200 MHz


class Core(AnywhereCase):
    def walked(self, compiler, *flags):
        program = self.path(compiler + "".join(flags))
        self.run_program(compiler, *C, *flags, "-I", str(CORE), WALK, str(CORE / "fdcg_firmware.c"), "-o", program)
        return self.run_program(program).stdout.decode().splitlines()[0]

    def board_object(self, processor):
        object_file = self.path(processor + "-core.o")
        self.run_program("arm-none-eabi-gcc", "-mcpu=" + processor, "-mthumb", "-mfloat-abi=hard", "-Os", *C, "-ffreestanding",
                         "-c", str(CORE / "fdcg_firmware.c"), "-o", object_file)
        return object_file

    def test_every_compiler_and_both_boards_give_the_same_answers(self):
        self.need("gcc", "clang", "arm-none-eabi-gcc", "qemu-system-arm")
        expected = self.walked("gcc", "-O0")
        self.assertRegex(expected, r"^[0-9a-f]{16} pushes \d{4,} tripped \d{2,}$")
        for compiler, level in (("gcc", "-O3"), ("clang", "-O0"), ("clang", "-O2")):
            self.assertEqual(expected, self.walked(compiler, level), compiler + level)
        for processor in ("cortex-m7", "cortex-m4"):
            program = self.firmware(processor, self.board_object(processor), WALK, flags=["-DFDCG_ON_BOARD", "-I", str(CORE)])
            # an instruction every 64 ns, SysTick at 25 MHz
            said = self.run_program(*qemu(processor, "-icount", "shift=6"), program).stdout.decode().splitlines()
            self.assertEqual(expected, said[0], processor)
            instructions = [int(ticks) * 40 // 64 for ticks in said[1].split()[1:]]
            print(f"{processor} -Os: instructions at most: make_input {instructions[0]}, take_output {instructions[1]}, "
                  f"force {instructions[2]}")
            self.assertGreater(instructions[0], 100)
            self.assertLess(max(instructions), LIMIT_INSTRUCTIONS)

    def test_it_is_small_and_asks_for_nothing_but_memcpy_and_memset(self):
        self.need("arm-none-eabi-gcc", "arm-none-eabi-size", "arm-none-eabi-nm")
        core = self.board_object("cortex-m7")
        code, data, zeroed = self.run_program("arm-none-eabi-size", core).stdout.decode().splitlines()[1].split()[:3]
        print(f"cortex-m7 -Os: {code} bytes of code and constants")
        self.assertLessEqual(int(code), LIMIT_BYTES)
        self.assertEqual(("0", "0"), (data, zeroed))
        lacking = {line.split()[-1] for line in self.run_program("arm-none-eabi-nm", "-u", core).stdout.decode().splitlines()}
        self.assertLessEqual(lacking, {"memcpy", "memset"})


if __name__ == "__main__":
    unittest.main()
