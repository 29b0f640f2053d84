#!/bin/sh
# Guess: an emulated Cortex-M4 sets the saturation flag Q of SMLAD only if the whole sum, of both products and the addend, overflows, as
# the architecture manual has it (ARMv7-M, SMLAD: the result is compared with the same number in 32 bits once).
#
# Seen, with Unicorn 2.1.4 on Python 3.11: SMLAD sets Q if the two products alone overflow, although the addend brings the sum back.
# -32768 * -32768 twice is 2^31, and with the addend -2147450880 it is 32768: the result is right, Q is 1. QEMU 7.2, from which
# Unicorn descends, leaves Q clear. SMUAD of the same numbers, which has no addend, must set it, and does.
#
# Code that checks Q after a filter by SMLAD sees saturations in this emulator that the chip does not have.
#
# Fails if result or flag changes.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/env"
"$folder/env/bin/pip" install --quiet --no-compile --disable-pip-version-check unicorn==2.1.4
"$folder/env/bin/python" - <<'PYTHON'
from unicorn import UC_ARCH_ARM, UC_MODE_MCLASS, UC_MODE_THUMB, Uc
from unicorn.arm_const import UC_ARM_REG_R1, UC_ARM_REG_R3, UC_ARM_REG_R4, UC_CPU_ARM_CORTEX_M4

FLASH = 0x0800_0000
CLEAR_FLAGS = "0024 84f30088"  # movs r4, #0; msr apsr_nzcvq, r4
READ_FLAGS = "eff30084"  # mrs r4, apsr


def result_and_q(instruction):
    chip = Uc(UC_ARCH_ARM, UC_MODE_THUMB | UC_MODE_MCLASS)
    chip.ctl_set_cpu_model(UC_CPU_ARM_CORTEX_M4)
    chip.mem_map(FLASH, 0x1000)
    code = bytes.fromhex(CLEAR_FLAGS + instruction + READ_FLAGS)
    chip.mem_write(FLASH, code)
    chip.reg_write(UC_ARM_REG_R1, 0x8000_8000)
    chip.emu_start(FLASH | 1, FLASH + len(code))
    return chip.reg_read(UC_ARM_REG_R3), chip.reg_read(UC_ARM_REG_R4) >> 27 & 1


seen = {}
for name, instruction in (("smlad r3, r1, r1, r1", "21fb0113"), ("smuad r3, r1, r1", "21fb01f3")):
    result, q = seen[name.split()[0]] = result_and_q(instruction)
    print(f"{name}, r1 = 0x80008000: r3 = {result:#010x}, Q = {q}")
assert seen == {"smlad": (0x8000, 1), "smuad": (0x8000_0000, 1)}, "CHANGED"
PYTHON
